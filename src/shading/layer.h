// SPDX-License-Identifier: Apache-2.0
// shading/layer.h: layers over a model, such as the fuzz of cloth. A layer reflects some of the
// light itself, and scales down what the model and the layers below it reflect. SIMD twin:
// cover_kernel.cc. Clear coats are not layers but surfaces of their own (scene/coat.h).
#pragma once

#include <string_view>
#include <variant>
#include <vector>

#include "brdf/angles.h"
#include "brdf/sheen.h"
#include "scene/material.h"

namespace nacre {

// The fuzz of cloth (brdf/sheen.h).
struct SheenModel {
  static constexpr std::string_view kName = "sheen";
  Rgb color{0, 0, 0};
  Charlie<double> charlie;
  SheenScaling scaling = SheenScaling::kReciprocal;
};

using LayerModel = std::variant<SheenModel>;

// The layers of a material, with the factors of its maps as parameters, bottom to top. Layers that
// reflect nothing, whatever the maps, are left out.
std::vector<LayerModel> MakeLayers(const Material& material);

// Removes the layers from a material and returns their names.
std::vector<std::string_view> RemoveLayers(Material* material);

// The reflection of one layer for one direction of light and one of view.
struct LayerReflection {
  Rgb lobe{0, 0, 0};  // f n.l of the layer itself
  double below = 1;   // the factor for the reflection of all that is below
};
LayerReflection EvaluateLayer(const LayerModel& layer, const Angles<double>& angles);

// At n.v, `lobe` is the directional albedo of the layer, and `below` the factor for light that
// arrives and leaves at the same angle, as by a mirror. The factor is used for ambient light, too,
// so that a white surface reflects all of it.
LayerReflection LayerAlbedo(const LayerModel& layer, double n_dot_v);

// Samples a direction to light for the layer's own reflection, with u0 and u1 in [0, 1). LayerPdf
// is the pdf of a direction at n.l, per solid angle.
Vec3d SampleLayer(const LayerModel& layer, const Vec3d& normal, double u0, double u1);
double LayerPdf(const LayerModel& layer, double n_dot_l);

}  // namespace nacre
