// SPDX-License-Identifier: Apache-2.0
// shading/share.h: the fraction of light that a material reflects in total, in double: as seen in a
// furnace, and for light from one direction. 1 is all of the light; more than 1 violates energy
// conservation.
//
// Both are the same for reciprocal models. They differ for models that are not reciprocal: the
// Phong family, and Turquin's compensation.
#pragma once

#include "shading/material.h"

namespace nacre {

enum class ShareOf : uint8_t {
  kFurnace,   // the radiance seen at this angle under radiance 1 from everywhere
  kOneLight,  // the fraction of light from this angle that is reflected in all directions
};

// `cosine` is n.v for kFurnace and n.l for kOneLight, in (0, 1]. `azimuth` is that of the direction
// about the normal in radians, from DefaultTangent's x before it is turned; only materials with
// anisotropic lobes look different from different azimuths. Theirs is a mean of 16 384 samples of a
// low-discrepancy sequence, others' a quadrature.
Rgb ReflectedShare(const ShadingMaterial& material, ShareOf what, double cosine,
                   double azimuth = 0);

// int (r.v)^n n.v dv over the hemisphere of v, for light at n.l = `cosine`, by quadrature: P in the
// table phong_albedo.
double PhongLobeIntegral(double shininess, double cosine);

}  // namespace nacre
