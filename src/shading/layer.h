// SPDX-License-Identifier: Apache-2.0
// shading/layer.h: layers over a model, such as the fuzz of cloth. A layer reflects some of the
// light itself, and leaves a share of what the model and the layers below it reflect. SIMD twin:
// layer_kernel.cc. Clear coats are no layers but surfaces of their own (scene/coat.h).
#pragma once

#include <string_view>
#include <variant>
#include <vector>

#include "brdf/angles.h"
#include "brdf/sheen.h"
#include "scene/material.h"

namespace nacre {

struct HitTextures;

// Fuzz: brdf/sheen.h.
struct SheenModel {
  static constexpr std::string_view kName = "sheen";
  Rgb color{0, 0, 0};
  Charlie<double> charlie;
  SheenScaling scaling = SheenScaling::kReciprocal;
};

using LayerModel = std::variant<SheenModel>;

// The layers of a material, of its maps' factors, bottom to top. One that shows nothing, whatever
// its maps, is left out.
std::vector<LayerModel> MakeLayers(const Material& material);

// Takes the layers from a material and returns their names.
std::vector<std::string_view> RemoveLayers(Material* material);

// A layer of a material with maps as it is at hit i.
LayerModel LayerAtHit(const LayerModel& layer, const HitTextures& textures, size_t i);

// One layer under one light, seen from one direction.
struct LayerReflection {
  Rgb lobe{0, 0, 0};  // f n.l of the layer itself
  double below = 1;   // what is left of the reflection of all that is below
};
LayerReflection EvaluateLayer(const LayerModel& layer, const Angles<double>& angles);

// Seen from n.v: the directional albedo of the layer, and what it leaves of light that comes and
// goes at the same angle, as by a mirror. It stands for light from everywhere as well, so that a
// white surface reflects all of it.
LayerReflection LayerAlbedo(const LayerModel& layer, double n_dot_v);

// A direction to light for the layer's own reflection, by u0 and u1 in [0, 1), and the pdf, per
// solid angle, of such a direction at n.l.
Vec3d SampleLayer(const LayerModel& layer, const Vec3d& normal, double u0, double u1);
double LayerPdf(const LayerModel& layer, double n_dot_l);

}  // namespace nacre
