// SPDX-License-Identifier: Apache-2.0
// scene_io/json_reader.h: reads values out of a JSON tree into plain variables. Whatever is wrong
// becomes a fault with its JSON pointer, and the variable keeps its default; so one pass over a
// file finds all of its faults.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/vec.h"
#include "scene/fault_list.h"
#include "scene/limits.h"
#include "scene_io/json_text.h"

namespace nacre {

// The location of a value in the file: a linked list of steps, each on the stack of the function
// that takes it. It is turned into a JSON pointer only if there is a fault.
struct JsonPath {
  static constexpr size_t kNoIndex = static_cast<size_t>(-1);

  const JsonPath* parent = nullptr;  // nullptr: the root of the file
  std::string_view name;             // name of an object's member,
  size_t index = kNoIndex;           // or index in an array

  JsonPath Member(std::string_view member) const { return {this, member, kNoIndex}; }
  JsonPath Element(size_t element) const { return {this, {}, element}; }
  std::string ToString() const;
};

// A value together with its location and the list for its faults: the argument of the Read
// functions. It must not outlive the tree, nor the JsonValue or JsonObject of the value that
// contains it.
struct JsonValue {
  const Json& json;
  JsonPath path;
  FaultList* faults;

  JsonValue Element(size_t i) const { return {json[i], path.Element(i), faults}; }

  void AddFault(std::string what, std::string hint = {}) const {
    faults->Add(path.ToString(), std::move(what), std::move(hint));
  }
  // Unless `is_right`, adds the fault "expected a number, got a string", with the hint. Returns
  // is_right.
  bool Expect(bool is_right, std::string_view expected, std::string_view hint = {}) const;
};

// Each returns whether it set *out. A colour is [r, g, b] or one number for grey.
bool ReadNumber(const JsonValue& value, const Range& range, double* out);
bool ReadWhole(const JsonValue& value, const Range& range, int64_t* out);
bool ReadColor(const JsonValue& value, const Range& range, Rgb* out);
bool ReadPoint(const JsonValue& value, const Range& range, Vec3d* out);
bool ReadText(const JsonValue& value, std::string* out);

// Reads one of `names`, which are of this kind, and sets *out to its index there.
bool ReadChoice(const JsonValue& value, std::string_view kind,
                std::span<const std::string_view> names, size_t* out);

// Reads two numbers, or one for both; `expected` describes them. Sets those that are valid.
void ReadTwoNumbers(const JsonValue& value, const Range& range, std::string_view expected,
                    double* first, double* second);

// Adds the faults of `error`, which is about the file that the value names, at the value's
// location.
void AddFileFaults(const Error& error, const JsonValue& value);

// Adds the fault that `word` is not among `names`. The hint is the nearest name, or all of them.
void FaultUnknownName(const JsonValue& value, std::string_view kind, const std::string& word,
                      const std::vector<std::string>& names);

// Adds the fault that `word` is not among the keys of `map`, which is in no order: the names are
// sorted, so that the hint does not depend on hashes.
template <class Map>
void FaultUnknownKey(const JsonValue& value, std::string_view kind, const std::string& word,
                     const Map& map) {
  std::vector<std::string> names;
  if (value.faults->count() < FaultList::kMaxKept) {  // further faults are only counted
    for (const auto& [known, item] : map) names.push_back(known);
  }
  std::sort(names.begin(), names.end());
  FaultUnknownName(value, kind, word, names);
}

// An object of the file. Remembers which members were asked for; RefuseOthers(), to be called last,
// adds a fault for each of the rest.
class JsonObject {
 public:
  // Adds a fault if the value is not an object, and then behaves like an empty one.
  explicit JsonObject(const JsonValue& value, std::string_view hint = {});
  JsonObject(const JsonObject&) = delete;
  JsonObject& operator=(const JsonObject&) = delete;

  // The member with this name; nullopt if there is none.
  std::optional<JsonValue> Find(std::string_view name);
  // The member with this name. If there is none, adds a fault.
  std::optional<JsonValue> Require(std::string_view name, std::string_view hint = {});

  // Each sets *out if the member is present and valid, and returns whether it did.
  bool Number(std::string_view name, const Range& range, double* out) {
    const auto value = Find(name);
    return value && ReadNumber(*value, range, out);
  }
  bool Color(std::string_view name, const Range& range, Rgb* out) {
    const auto value = Find(name);
    return value && ReadColor(*value, range, out);
  }
  bool Point(std::string_view name, Vec3d* out) {
    const auto value = Find(name);
    return value && ReadPoint(*value, limits::kCoordinate, out);
  }
  bool Boolean(std::string_view name, bool* out);
  bool Text(std::string_view name, std::string* out) {
    const auto value = Find(name);
    return value && ReadText(*value, out);
  }
  template <typename Int>
  bool Whole(std::string_view name, const Range& range, Int* out) {
    int64_t whole = 0;
    const auto value = Find(name);
    const bool is_set = value && ReadWhole(*value, range, &whole);
    if (is_set) *out = static_cast<Int>(whole);
    return is_set;
  }
  // Reads one of `names` and sets *out, an integer or an enumeration, to its index there.
  template <typename Index>
  bool Choice(std::string_view name, std::span<const std::string_view> names, Index* out) {
    size_t index = 0;
    const auto value = Find(name);
    const bool is_set = value && ReadChoice(*value, name, names, &index);
    if (is_set) *out = static_cast<Index>(index);
    return is_set;
  }

  void RefuseOthers();

  bool is_object() const { return value_.json.is_object(); }
  FaultList* faults() const { return value_.faults; }
  const JsonValue& value() const { return value_; }

 private:
  JsonValue value_;
  std::vector<std::string_view> known_;
};

}  // namespace nacre
