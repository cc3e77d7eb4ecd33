// SPDX-License-Identifier: Apache-2.0
// shading/sheen.h: a layer of fuzz over what a model reflects: brdf/sheen.h of a material, or of a
// hit that maps give a colour and a roughness of its own.
#pragma once

#include <algorithm>
#include <optional>

#include "brdf/sheen.h"
#include "scene/material.h"

namespace nacre {

struct SheenModel {
  Rgb color{0, 0, 0};
  Charlie<double> charlie;
};

inline double LargestChannel(const Rgb& color) { return std::max({color.x, color.y, color.z}); }

// None for materials without sheen, whatever their maps.
std::optional<SheenModel> MakeSheen(const Material& material);

// How the layer and what is below it share light from n.l towards n.v.
inline SheenScale<double> ShareLight(const SheenModel& sheen, double n_dot_l, double n_dot_v) {
  return ScaleSheen(LargestChannel(sheen.color), CharlieAlbedo(sheen.charlie, n_dot_v),
                    CharlieAlbedo(sheen.charlie, n_dot_l));
}

}  // namespace nacre
