// SPDX-License-Identifier: Apache-2.0
// view/explain.h: where a pixel's value comes from: what lies there, and what each light adds.
#pragma once

#include <functional>

#include "base/image.h"
#include "scene/scene.h"
#include "scene_io/json_text.h"

namespace nacre {

// A pixel through its centre.
struct PixelLayers {
  Image all;            // all layers
  Image diffuse_light;  // the same by RenderSettings::diffuse_light_layers
  int samples = 1;      // of lights with an extent
};

// All layers of the pixel while another material is in the place of this one.
using PixelWith = std::function<Image(size_t material, const Material& other)>;

// Directions and terms are in double, by the scalar twins, at the hit's position and normal; what
// the renderer made of them in float stands beside, by light and component: these add up to the
// pixel's value. Maps are looked up by `pixel_with`.
Json ExplainPixel(const Scene& scene, const PixelLayers& pixel, const PixelWith& pixel_with);

}  // namespace nacre
