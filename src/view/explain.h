// SPDX-License-Identifier: Apache-2.0
// view/explain.h: explains a pixel's value: what is visible there, and what each light contributes.
#pragma once

#include <functional>

#include "base/image.h"
#include "scene/scene.h"
#include "scene_io/json_text.h"

namespace nacre {

// Renders of a single pixel through its centre.
struct PixelLayers {
  Image all;            // all layers
  Image diffuse_light;  // all layers with RenderSettings::diffuse_light_layers
  int samples = 1;      // per light with an extent
};

// Renders all layers of the pixel while the material with this index is replaced by `other`.
using PixelWith = std::function<Image(size_t material, const Material& other)>;

// Directions and terms are computed in double with the scalar twins, at the hit's position and
// normal. Beside them are the renderer's float results by light and component, which add up to the
// pixel's value. `pixel_with` is used to look up maps.
Json ExplainPixel(const Scene& scene, const PixelLayers& pixel, const PixelWith& pixel_with);

}  // namespace nacre
