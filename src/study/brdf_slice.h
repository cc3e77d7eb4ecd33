// SPDX-License-Identifier: Apache-2.0
// study/brdf_slice.h: reflection models as pictures: the slice of a BRDF that tells most of it.
#pragma once

#include <vector>

#include "study/material_curves.h"

namespace nacre {

// Light and viewer of a place in the slice: the half vector `theta_h` from the normal, the light
// `theta_d` from the half vector, at right angles to the plane of both (phi_d = 90 degrees;
// Rusinkiewicz 1998). Both are above the surface below 90 degrees.
struct SliceDirections {
  Vec3d to_light, to_view;
};
SliceDirections DirectionsOfSlice(double theta_h_deg, double theta_d_deg);

// For each material, the BRDF over theta_h and theta_d as colours, all on one scale, which grazing
// light may exceed (Burley 2012, figure 3): the highlight at the left, Fresnel's effect at the top,
// grazing light retroreflected at the right.
std::vector<Plot> SlicePlots(const std::vector<NamedMaterial>& materials, ColorChannel channel);

}  // namespace nacre
