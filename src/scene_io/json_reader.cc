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
  switch (json.type()) {
    case Json::value_t::null:
      return "null";
    case Json::value_t::boolean:
      return "true or false";
    case Json::value_t::string:
      return "a string";
    case Json::value_t::array:
      return "an array";
    case Json::value_t::object:
      return "an object";
    default:
      return "a number";
  }
}

std::string NumberHint(const Range& range) { return "a number " + Describe(range); }

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

void JsonValue::AddFault(std::string what, std::string hint) const {
  faults->Add(path.ToString(), std::move(what), std::move(hint));
}

bool JsonValue::Expect(bool is_right, std::string_view expected, std::string_view hint) const {
  if (is_right) return true;
  std::string got(KindOf(json));
  if (json.is_array()) got += fmt::format(" of {}", json.size());
  AddFault(fmt::format("expected {}, got {}", expected, got), std::string(hint));
  return false;
}

bool ReadNumber(const JsonValue& value, const Range& range, double* out) {
  if (!value.Expect(value.json.is_number(), "a number", NumberHint(range))) return false;
  const auto number = value.json.get<double>();
  if (!range.Contains(number)) {
    value.AddFault(fmt::format("{} is out of range", number), NumberHint(range));
    return false;
  }
  *out = number;
  return true;
}

bool ReadWhole(const JsonValue& value, const Range& range, int64_t* out) {
  double number = 0;
  const std::string hint = "a whole number " + Describe(range);
  if (!value.Expect(value.json.is_number(), "a whole number", hint)) return false;
  number = value.json.get<double>();
  if (number != std::floor(number)) {
    value.AddFault(fmt::format("{} is not a whole number", number), hint);
    return false;
  }
  if (!range.Contains(number)) {
    value.AddFault(fmt::format("{} is out of range", number), hint);
    return false;
  }
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
  std::string word;
  if (!ReadText(value, &word)) return false;
  const auto found = std::find(names.begin(), names.end(), word);
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

bool JsonObject::Number(std::string_view name, const Range& range, double* out) {
  const auto value = Find(name);
  return value && ReadNumber(*value, range, out);
}

bool JsonObject::Color(std::string_view name, const Range& range, Rgb* out) {
  const auto value = Find(name);
  return value && ReadColor(*value, range, out);
}

bool JsonObject::Point(std::string_view name, Vec3d* out) {
  const auto value = Find(name);
  return value && ReadPoint(*value, limits::kCoordinate, out);
}

bool JsonObject::Boolean(std::string_view name, bool* out) {
  const auto value = Find(name);
  if (!value || !value->Expect(value->json.is_boolean(), "true or false")) return false;
  *out = value->json.get<bool>();
  return true;
}

bool JsonObject::Text(std::string_view name, std::string* out) {
  const auto value = Find(name);
  return value && ReadText(*value, out);
}

bool JsonObject::WholeNumber(std::string_view name, const Range& range, int64_t* out) {
  const auto value = Find(name);
  return value && ReadWhole(*value, range, out);
}

bool JsonObject::Choice(std::string_view name, std::span<const std::string_view> names,
                        size_t* out) {
  const auto value = Find(name);
  return value && ReadChoice(*value, name, names, out);
}

void JsonObject::RefuseOthers() {
  if (!is_object()) return;
  for (const auto& [name, member] : value_.json.items()) {
    if (std::find(known_.begin(), known_.end(), name) != known_.end()) continue;
    FaultUnknownName(value_, "key", name, {known_.begin(), known_.end()});
  }
}

}  // namespace nacre
