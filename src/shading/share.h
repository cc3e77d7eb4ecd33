// SPDX-License-Identifier: Apache-2.0
// shading/share.h: how much light a material reflects in all, in double and by quadrature: what a
// furnace shows, and what becomes of the light from one direction. 1 is all of it; more is made
// from nothing.
//
// Both are the same for reciprocal models. Those that are not (the Phong family, Turquin's
// compensation) reflect otherwise than they look.
#pragma once

#include "shading/material.h"

namespace nacre {

enum class ShareOf : uint8_t {
  kFurnace,   // the radiance seen at this angle under radiance 1 from everywhere
  kOneLight,  // of light from this angle, all that is reflected
};

// cosine: n.v of the furnace, n.l of the one light, in (0, 1].
Rgb ReflectedShare(const ShadingMaterial& material, ShareOf what, double cosine);

// int (r.v)^n n.v dv over the hemisphere of v, for light from this angle: the table phong_albedo's
// P. By quadrature.
double PhongLobeIntegral(double shininess, double cosine);

}  // namespace nacre
