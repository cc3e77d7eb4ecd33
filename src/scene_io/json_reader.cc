// SPDX-License-Identifier: Apache-2.0
#include "scene_io/json_reader.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/error.h"
#include "base/excerpt.h"

namespace nacre {
namespace {

// The kind of a value in words: "a string", "an object".
std::string_view KindOf(const Json& json) {
  return json.is_null()      ? "null"
         : json.is_boolean() ? "true or false"
         : json.is_string()  ? "a string"
         : json.is_array()   ? "an array"
         : json.is_object()  ? "an object"
                             : "a number";
}

// Reads a number that is of this kind, "a number" or "a whole number", and in the range.
bool ReadInRange(const JsonValue& value, std::string_view kind, bool is_whole, const Range& range,
                 double* out) {
  const std::string hint = fmt::format("{} {}", kind, Describe(range));
  if (!value.Expect(value.json.is_number(), kind, hint)) return false;
  const auto number = value.json.get<double>();
  const bool is_kind = !is_whole || number == std::floor(number);
  if (!is_kind || !range.Contains(number)) {
    value.AddFault(is_kind ? fmt::format("{} is out of range", number)
                           : fmt::format("{} is not {}", number, kind),
                   hint);
    return false;
  }
  *out = number;
  return true;
}

std::string ComponentHint(const Range& range) {
  return "[r, g, b] or one number for grey, each " + Describe(range);
}

bool ReadTriple(const JsonValue& value, const Range& range, std::string_view hint, double* out) {
  const Json& json = value.json;
  if (!value.Expect(json.is_array() && json.size() == 3, "three numbers", hint)) return false;
  double triple[3];
  bool is_right = true;
  for (size_t i = 0; i < 3; ++i) {
    is_right &= ReadNumber(value.Element(i), range, &triple[i]);
  }
  if (is_right) std::copy_n(triple, 3, out);
  return is_right;
}

}  // namespace

std::string JsonPath::ToString() const {
  if (parent == nullptr) return {};
  const std::string token = index == kNoIndex ? PointerToken(name) : std::to_string(index);
  return parent->ToString() + "/" + token;
}

bool JsonValue::Expect(bool is_right, std::string_view expected, std::string_view hint) const {
  if (is_right) return true;
  std::string got(KindOf(json));
  if (json.is_array()) got += fmt::format(" of {}", json.size());
  AddFault(fmt::format("expected {}, got {}", expected, got), std::string(hint));
  return false;
}

bool ReadNumber(const JsonValue& value, const Range& range, double* out) {
  return ReadInRange(value, "a number", /*is_whole=*/false, range, out);
}

bool ReadWhole(const JsonValue& value, const Range& range, int64_t* out) {
  double number = 0;
  if (!ReadInRange(value, "a whole number", /*is_whole=*/true, range, &number)) return false;
  *out = static_cast<int64_t>(number);
  return true;
}

bool ReadColor(const JsonValue& value, const Range& range, Rgb* out) {
  if (value.json.is_number()) {
    double grey = 0;
    if (!ReadNumber(value, range, &grey)) return false;
    *out = Rgb(grey, grey, grey);
    return true;
  }
  if (!value.Expect(value.json.is_array(), "a colour", ComponentHint(range))) return false;
  return ReadTriple(value, range, ComponentHint(range), &out->x);
}

bool ReadPoint(const JsonValue& value, const Range& range, Vec3d* out) {
  return ReadTriple(value, range, "[x, y, z], each " + Describe(range), &out->x);
}

bool ReadText(const JsonValue& value, std::string* out) {
  if (!value.Expect(value.json.is_string(), "a string")) return false;
  *out = value.json.get<std::string>();
  return true;
}

void ReadTwoNumbers(const JsonValue& value, const Range& range, std::string_view expected,
                    double* first, double* second) {
  if (value.json.is_number()) {
    if (ReadNumber(value, range, first)) *second = *first;
    return;
  }
  if (!value.Expect(value.json.is_array() && value.json.size() == 2, expected)) return;
  ReadNumber(value.Element(0), range, first);
  ReadNumber(value.Element(1), range, second);
}

bool ReadChoice(const JsonValue& value, std::string_view kind,
                std::span<const std::string_view> names, size_t* out) {
  // A number stands for its text, such as a version's.
  std::string word = value.json.is_number() ? value.json.dump() : "";
  auto found = std::find(names.begin(), names.end(), word);
  if (found == names.end()) {
    if (!ReadText(value, &word)) return false;
    found = std::find(names.begin(), names.end(), word);
  }
  if (found == names.end()) {
    FaultUnknownName(value, kind, word, {names.begin(), names.end()});
    return false;
  }
  *out = static_cast<size_t>(found - names.begin());
  return true;
}

void AddFileFaults(const Error& error, const JsonValue& value) {
  for (const Fault& fault : error.faults()) {
    value.AddFault(fault.where.empty() ? fault.what : fault.where + ": " + fault.what, fault.hint);
  }
}

void FaultUnknownName(const JsonValue& value, std::string_view kind, const std::string& word,
                      const std::vector<std::string>& names) {
  // No hint for faults that are only counted: there may be a million, each with a million names to
  // compare.
  const bool is_kept = value.faults->count() < FaultList::kMaxKept;
  const std::string nearest = is_kept ? NearestName(word, names) : std::string();
  std::string hint;
  constexpr ptrdiff_t kMaxNames = 100;
  const auto count = std::min(static_cast<ptrdiff_t>(names.size()), kMaxNames);
  if (!nearest.empty()) {
    hint = fmt::format("did you mean \"{}\"?", nearest);
  } else if (is_kept && count > 0) {
    constexpr size_t kLongest = 400;
    hint =
        Excerpt(fmt::format("one of: {}{}", fmt::join(names.begin(), names.begin() + count, ", "),
                            count == kMaxNames ? ", ..." : ""),
                kLongest);
  }
  value.AddFault(fmt::format("unknown {} \"{}\"", kind, Excerpt(word)), hint);
}

JsonObject::JsonObject(const JsonValue& value, std::string_view hint) : value_(value) {
  known_.reserve(8);
  value.Expect(value.json.is_object(), "an object", hint);
}

std::optional<JsonValue> JsonObject::Find(std::string_view name) {
  if (std::find(known_.begin(), known_.end(), name) == known_.end()) known_.push_back(name);
  if (!is_object()) return std::nullopt;
  const auto found = value_.json.find(name);
  if (found == value_.json.end()) return std::nullopt;
  return JsonValue{*found, value_.path.Member(name), faults()};
}

std::optional<JsonValue> JsonObject::Require(std::string_view name, std::string_view hint) {
  const std::optional<JsonValue> found = Find(name);
  if (!found && is_object()) {
    value_.AddFault(fmt::format("missing key \"{}\"", name), std::string(hint));
  }
  return found;
}

bool JsonObject::Boolean(std::string_view name, bool* out) {
  const auto value = Find(name);
  if (!value || !value->Expect(value->json.is_boolean(), "true or false")) return false;
  *out = value->json.get<bool>();
  return true;
}

void JsonObject::RefuseOthers() {
  if (!is_object()) return;
  for (const auto& [name, member] : value_.json.items()) {
    if (std::find(known_.begin(), known_.end(), name) != known_.end()) continue;
    FaultUnknownName(value_, "key", name, {known_.begin(), known_.end()});
  }
}

}  // namespace nacre
