// SPDX-License-Identifier: Apache-2.0
#include "scene_io/read_keys.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scene/filter_width.h"
#include "scene_io/readers.h"

namespace nacre {
namespace {

void ReadFilter(const JsonValue& value, ImageSettings* image) {
  JsonObject object(value, R"(for example {"type": "gaussian", "width": 3})");
  PixelFilter& filter = image->filter;
  constexpr double kUnset = 0;  // outside of the range of its width
  filter.width = kUnset;
  ReadInnerKeys("filter", &object, image);
  if (filter.width == kUnset) filter.width = DefaultFilterWidth(filter.kind);
  object.RefuseOthers();
}

}  // namespace

std::string HintOf(KeyForm form, const Range& range, std::span<const std::string_view> options,
                   std::string_view meaning) {
  const auto with_meaning = [&](const std::string& hint) {
    return meaning.empty() ? hint : hint + ": " + std::string(meaning);
  };
  switch (form) {
    case KeyForm::kChoice:
      return fmt::format("one of: {}", fmt::join(options, ", "));
    case KeyForm::kBoolean:
      return with_meaning("true or false");
    case KeyForm::kWhole:
      return with_meaning("a whole number " + Describe(range));
    case KeyForm::kPoint:
      return with_meaning("[x, y, z]");
    case KeyForm::kDirection:  // the meaning says more
      return std::string(meaning);
    case KeyForm::kColor:
      return with_meaning("[r, g, b] or grey");
    case KeyForm::kNumber:
      break;
  }
  return with_meaning(range == limits::kLength ? "a length greater than 0"
                                               : "a number " + Describe(range));
}

std::optional<Vec3d> ReadKeyValue(JsonObject* object, std::string_view name, KeyForm form,
                                  const Range& range, std::span<const std::string_view> options) {
  const auto number = [](auto value) { return Vec3d(static_cast<double>(value), 0, 0); };
  switch (form) {
    case KeyForm::kNumber:
      if (double value = 0; object->Number(name, range, &value)) return number(value);
      break;
    case KeyForm::kWhole:
      if (int64_t value = 0; object->Whole(name, range, &value)) return number(value);
      break;
    case KeyForm::kColor:
      if (Rgb value; object->Color(name, range, &value)) return Vec3d(value);
      break;
    case KeyForm::kPoint:
    case KeyForm::kDirection:
      if (Vec3d value; object->Point(name, &value)) return value;
      break;
    case KeyForm::kBoolean:
      if (bool value = false; object->Boolean(name, &value)) return number(value);
      break;
    case KeyForm::kChoice:
      if (size_t value = 0; object->Choice(name, options, &value)) return number(value);
      break;
  }
  return std::nullopt;
}

Json KeyValueJson(KeyForm form, std::span<const std::string_view> options, const Vec3d& value) {
  switch (form) {
    case KeyForm::kNumber:
      break;
    case KeyForm::kWhole:
      return static_cast<int64_t>(value.x);
    case KeyForm::kColor:
      if (value.x == value.y && value.y == value.z) return value.x;
      return {value.x, value.y, value.z};
    case KeyForm::kPoint:
    case KeyForm::kDirection:
      return {value.x, value.y, value.z};
    case KeyForm::kBoolean:
      return value.x != 0;
    case KeyForm::kChoice:
      return options[static_cast<size_t>(value.x)];
  }
  return value.x;
}

void ReadCamera(const JsonValue& value, Camera* camera) {
  JsonObject object(value);
  // The first key, the type, decides which other keys there are.
  ReadKey(KeysFor(*camera).front(), &object, camera);
  for (const auto& key : KeysFor(*camera).subspan(1)) ReadKey(key, &object, camera);
  object.RefuseOthers();
}

void ReadImageSettings(const JsonValue& value, ImageSettings* image) {
  JsonObject object(value);
  ReadKeys(&object, image);
  if (const auto filter = object.Find("filter")) ReadFilter(*filter, image);
  object.RefuseOthers();
}

}  // namespace nacre
