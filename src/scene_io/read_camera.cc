// SPDX-License-Identifier: Apache-2.0
// scene_io/read_camera.cc: the parts "camera" and "image".
#include "scene/filter_width.h"
#include "scene_io/read_keys.h"
#include "scene_io/readers.h"

namespace nacre {
namespace {

constexpr double kUnset = 0;  // outside of the range of a filter's width

void ReadFilter(const JsonValue& value, ImageSettings* image) {
  JsonObject object(value, R"(for example {"type": "gaussian", "width": 3})");
  PixelFilter& filter = image->filter;
  filter.width = kUnset;
  ReadInnerKeys("filter", &object, image);
  if (filter.width == kUnset) filter.width = DefaultFilterWidth(filter.kind);
  object.RefuseOthers();
}

}  // namespace

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
