// SPDX-License-Identifier: Apache-2.0
// view/explain.h: where a pixel's value comes from: what lies there, and what each light adds.
#pragma once

#include <functional>

#include "base/image.h"
#include "scene/scene.h"
#include "scene_io/json_text.h"

namespace nacre {

// The albedo layer of the pixel while another material is in the place of this one.
using AlbedoWith = std::function<Rgb(size_t material, const Material& other)>;

// `pixel`: all layers of one pixel of the scene, of one sample through its centre. Directions and
// terms are in double, by the scalar twins, at the hit's position and normal; what the renderer
// made of them in float stands beside. Maps are looked up by `albedo_with`.
Json ExplainPixel(const Scene& scene, const Image& pixel, const AlbedoWith& albedo_with);

}  // namespace nacre
