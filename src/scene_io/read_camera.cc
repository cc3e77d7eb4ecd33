// SPDX-License-Identifier: Apache-2.0
// scene_io/read_camera.cc: the parts "camera" and "image".
#include <array>

#include "scene/filter_width.h"
#include "scene_io/readers.h"

namespace nacre {
namespace {

// In the orders of Projection and FilterKind.
constexpr std::array<std::string_view, 2> kProjections = {"perspective", "orthographic"};
constexpr std::array<std::string_view, 4> kFilters = {"box", "gaussian", "blackman_harris",
                                                      "mitchell"};

void ReadFilter(const JsonValue& value, PixelFilter* filter) {
  JsonObject object(value, R"(for example {"type": "gaussian", "width": 3})");
  object.Require("type", "one of: box, gaussian, blackman_harris, mitchell");
  size_t kind = 0;
  if (object.Choice("type", kFilters, &kind)) {
    filter->kind = static_cast<FilterKind>(kind);
    filter->width = DefaultFilterWidth(filter->kind);
  }
  object.Number("width", limits::kFilterWidth, &filter->width);
  object.RefuseOthers();
}

}  // namespace

void ReadCamera(const JsonValue& value, Camera* camera) {
  JsonObject object(value);
  size_t projection = 0;
  if (object.Choice("type", kProjections, &projection)) {
    camera->projection = static_cast<Projection>(projection);
  }
  object.Point("position", &camera->position);
  object.Point("look_at", &camera->look_at);
  object.Point("up", &camera->up);
  if (camera->projection == Projection::kPerspective) {
    object.Number("fov_y_deg", limits::kFovYDeg, &camera->fov_y_deg);
  } else {
    object.Number("height", limits::kLength, &camera->height);
  }
  object.RefuseOthers();
}

void ReadImageSettings(const JsonValue& value, ImageSettings* image) {
  JsonObject object(value);
  object.Whole("width", limits::kImageSide, &image->width);
  object.Whole("height", limits::kImageSide, &image->height);
  object.Whole("spp", limits::kSpp, &image->spp);
  if (const Json* filter = object.Find("filter")) {
    ReadFilter({*filter, object.path().Member("filter"), object.faults()}, &image->filter);
  }
  object.Whole("seed", limits::kSeed, &image->seed);
  object.Boolean("shadows", &image->shadows);
  object.Boolean("culling", &image->culling);
  object.RefuseOthers();
}

}  // namespace nacre
