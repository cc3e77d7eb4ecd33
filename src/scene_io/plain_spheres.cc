// SPDX-License-Identifier: Apache-2.0
#include "scene_io/plain_spheres.h"

#include <charconv>
#include <system_error>

#include <nlohmann/json.hpp>

namespace nacre {
namespace {

bool IsDigit(char c) { return c >= '0' && c <= '9'; }

// Takes JSON tokens off the front of a text. Each function returns whether its token came next; if
// not, the position in the text is undefined.
class Tokens {
 public:
  Tokens(const char* at, const char* end) : at_(at), end_(end) {}
  const char* at() const { return at_; }

  bool Take(char c) {
    SkipBlanks();
    if (!Is(c)) return false;
    ++at_;
    return true;
  }

  // A string without escapes, without its quotation marks. Its bytes may be invalid UTF-8.
  bool TakeText(std::string_view* text) {
    if (!Take('"')) return false;
    const char* const begin = at_;
    while (at_ != end_ && *at_ != '"' && *at_ != '\\' && static_cast<unsigned char>(*at_) >= 0x20) {
      ++at_;
    }
    *text = {begin, static_cast<size_t>(at_ - begin)};
    return Take('"');
  }

  // A number in JSON's grammar that neither overflows nor underflows a double.
  bool TakeNumber(double* number) {
    SkipBlanks();
    const char* const begin = at_;
    if (Is('-')) ++at_;
    if (Is('0')) {
      ++at_;
    } else if (!SkipDigits()) {
      return false;
    }
    bool is_whole = true;
    if (Is('.')) {
      ++at_;
      is_whole = false;
      if (!SkipDigits()) return false;
    }
    if (Is('e') || Is('E')) {
      ++at_;
      is_whole = false;
      if (Is('-') || Is('+')) ++at_;
      if (!SkipDigits()) return false;
    }
    const auto [read, error] = std::from_chars(begin, at_, *number);
    if (is_whole && *number == 0) *number = 0;  // the tree's parser takes -0 for an integer
    return error == std::errc() && read == at_;
  }

  bool TakePoint(Vec3d* point) {
    return Take('[') && TakeNumber(&point->x) && Take(',') && TakeNumber(&point->y) && Take(',') &&
           TakeNumber(&point->z) && Take(']');
  }

 private:
  bool Is(char c) const { return at_ != end_ && *at_ == c; }

  void SkipBlanks() {
    while (at_ != end_ && (*at_ == ' ' || *at_ == '\n' || *at_ == '\r' || *at_ == '\t')) ++at_;
  }

  bool SkipDigits() {
    const char* const begin = at_;
    while (at_ != end_ && IsDigit(*at_)) ++at_;
    return at_ != begin;
  }

  const char* at_;
  const char* end_;
};

}  // namespace

std::optional<Sphere> PlainSphereReader::Next(const char** at, const char* end) {
  Tokens tokens(*at, end);
  if (!tokens.Take(',') || !tokens.Take('{')) return std::nullopt;
  Sphere sphere;
  enum : unsigned { kType = 1, kCenter = 2, kRadius = 4, kMaterial = 8, kAll = 15 };
  unsigned seen = 0;
  std::string_view material;
  do {
    std::string_view name;
    if (!tokens.TakeText(&name) || !tokens.Take(':')) return std::nullopt;
    unsigned member = 0;
    bool is_right = false;
    if (name == "type") {
      std::string_view type;
      member = kType;
      is_right = tokens.TakeText(&type) && type == "sphere";
    } else if (name == "center") {
      member = kCenter;
      is_right = tokens.TakePoint(&sphere.center);
    } else if (name == "radius") {
      member = kRadius;
      is_right = tokens.TakeNumber(&sphere.radius);
    } else if (name == "material") {
      member = kMaterial;
      is_right = tokens.TakeText(&material);
    }
    if (!is_right || (seen & member) != 0) return std::nullopt;
    seen |= member;
  } while (tokens.Take(','));
  if (seen != kAll || !tokens.Take('}')) return std::nullopt;
  const std::optional<MaterialId> place = PlaceOf(material);
  if (!place) return std::nullopt;
  sphere.material = *place;
  *at = tokens.at();
  return sphere;
}

std::optional<MaterialId> PlainSphereReader::PlaceOf(std::string_view name) {
  if (last_place_.valid() && name == last_name_) return last_place_;
  auto found = places_.find(name);
  if (found == places_.end()) {
    // The JSON parser decides whether the name is valid UTF-8.
    const nlohmann::json json = nlohmann::json::parse('"' + std::string(name) + '"', nullptr,
                                                      /*allow_exceptions=*/false);
    if (json.is_discarded()) return std::nullopt;
    found = places_.emplace(name, MaterialId{static_cast<uint32_t>(materials_.size())}).first;
    materials_.push_back(json.get<std::string>());
  }
  last_name_ = name;
  last_place_ = found->second;
  return last_place_;
}

}  // namespace nacre
