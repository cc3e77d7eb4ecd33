// SPDX-License-Identifier: Apache-2.0
// scene_io/json_reader.h: reads values out of a JSON tree into plain variables. Whatever is wrong
// becomes a fault with its JSON pointer, and the variable keeps its default; so one pass over a
// file finds all of its faults.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "base/vec.h"
#include "scene/fault_list.h"
#include "scene/limits.h"
#include "scene_io/json_text.h"

namespace nacre {

// Where a value is in the file: a chain of steps, each on the stack of the function that takes it,
// spelled out as a JSON pointer only for a fault.
struct JsonPath {
  static constexpr size_t kNoIndex = static_cast<size_t>(-1);

  const JsonPath* parent = nullptr;  // nullptr: this is the whole file
  std::string_view name;             // of a member of an object,
  size_t index = kNoIndex;           // or the place in an array

  JsonPath Member(std::string_view member) const { return {this, member, kNoIndex}; }
  JsonPath Element(size_t element) const { return {this, {}, element}; }
  std::string ToString() const;
};

// A value together with its place and where to report: what the Read functions take. It may outlive
// neither the tree nor the JsonValue or JsonObject of the value around it.
struct JsonValue {
  const Json& json;
  JsonPath path;
  FaultList* faults;

  void AddFault(std::string what, std::string hint = {}) const;
  // Faults "expected a number, got a string", with the hint, unless `is_right`; returns is_right.
  bool Expect(bool is_right, std::string_view expected, std::string_view hint = {}) const;
};

// Each returns whether it set *out. Colours are [r, g, b] or one number for grey.
bool ReadNumber(const JsonValue& value, const Range& range, double* out);
bool ReadWhole(const JsonValue& value, const Range& range, int64_t* out);
bool ReadColor(const JsonValue& value, const Range& range, Rgb* out);
bool ReadPoint(const JsonValue& value, const Range& range, Vec3d* out);
bool ReadText(const JsonValue& value, std::string* out);

// Reports what is wrong with the file that the value names, or in it.
void AddFileFaults(const Error& error, const JsonValue& value);

// Reports that `word` is none of the names, with the nearest one or all of them as the hint.
void FaultUnknownName(const JsonValue& value, std::string_view kind, const std::string& word,
                      const std::vector<std::string>& names);

// An object of the file. Remembers which members were asked for; RefuseOthers(), to be called
// last, makes faults of the rest.
class JsonObject {
 public:
  // Faults if the value is no object, and then behaves like an empty one.
  explicit JsonObject(const JsonValue& value, std::string_view hint = {});
  JsonObject(const JsonObject&) = delete;
  JsonObject& operator=(const JsonObject&) = delete;

  // The member, or nullptr if there is none.
  const Json* Find(std::string_view name);
  // The same, but its absence is a fault.
  const Json* Require(std::string_view name, std::string_view hint = {});

  // Each sets *out if the member is there and right, and returns whether it did.
  bool Number(std::string_view name, const Range& range, double* out);
  bool Color(std::string_view name, const Range& range, Rgb* out);
  bool Point(std::string_view name, Vec3d* out);
  bool Boolean(std::string_view name, bool* out);
  bool Text(std::string_view name, std::string* out);
  template <typename Int>
  bool Whole(std::string_view name, const Range& range, Int* out) {
    int64_t whole = 0;
    const bool is_set = WholeNumber(name, range, &whole);
    if (is_set) *out = static_cast<Int>(whole);
    return is_set;
  }
  // A name out of `names`; sets *out to its position there.
  bool Choice(std::string_view name, std::span<const std::string_view> names, size_t* out);

  void RefuseOthers();

  bool is_object() const { return value_.json.is_object(); }
  const JsonPath& path() const { return value_.path; }
  FaultList* faults() const { return value_.faults; }
  const JsonValue& value() const { return value_; }

 private:
  bool WholeNumber(std::string_view name, const Range& range, int64_t* out);

  JsonValue value_;
  std::vector<std::string_view> known_;
};

}  // namespace nacre
