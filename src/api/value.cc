// SPDX-License-Identifier: Apache-2.0
// api/value.cc: converts values of the public API to the JSON text of scene files.
#include <cmath>

#include <fmt/format.h>

#include "api/border.h"
#include "scene_io/json_text.h"

namespace nacre::v0 {
namespace {

std::string Quoted(const std::string& text) {
  // Invalid UTF-8 is refused here, as it would be in a file.
  try {
    return nacre::Json(text).dump();
  } catch (const nacre::Json::exception&) {
    throw v0::ToPublic(nacre::Error(ExitCode::kUsage, "", "a text is not UTF-8"));
  }
}

template <class List, class ToText>
std::string JoinJson(char open, const List& list, char close, const ToText& to_text) {
  std::string text(1, open);
  for (const auto& element : list) {
    if (text.size() > 1) text += ',';
    text += to_text(element);
  }
  return text + close;
}

}  // namespace

std::string Value::ToJson(double number) {
  if (!std::isfinite(number)) {
    throw v0::ToPublic(
        nacre::Error(ExitCode::kUsage, "", fmt::format("{} is not a finite number", number)));
  }
  const DefaultFloatMode mode;       // DAZ would make denormals 0
  return fmt::format("{}", number);  // the shortest text that parses to the same double
}

std::string Value::ToJson(bool truth) { return truth ? "true" : "false"; }

Value::Value(double x, double y, double z) : Value(Vec3{x, y, z}) {}
Value::Value(const Vec3& xyz)
    : json_(JoinJson('[', xyz, ']', [](double number) { return ToJson(number); })) {}
Value::Value(const char* text) : json_(Quoted(text)) {}
Value::Value(const std::string& text) : json_(Quoted(text)) {}
Value::Value(const std::vector<double>& list)
    : json_(JoinJson('[', list, ']', [](double number) { return ToJson(number); })) {}
Value::Value(const std::vector<std::string>& list) : json_(JoinJson('[', list, ']', Quoted)) {}
Value::Value(const Parameters& object)
    : json_(JoinJson('{', object, '}', [](const Parameter& parameter) {
        return Quoted(parameter.name) + ':' + parameter.value.json();
      })) {}

Value Value::Json(std::string text) {
  Value value;
  value.json_ = std::move(text);
  return value;
}

}  // namespace nacre::v0
