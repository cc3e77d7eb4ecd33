// SPDX-License-Identifier: Apache-2.0
// study/brdf_slice.h: shows BRDFs as pictures of their most informative slice.
#pragma once

#include <vector>

#include "study/material_curves.h"

namespace nacre {

// The directions at a point of the slice: the half vector is `theta_h` from the normal, and the
// light `theta_d` from the half vector, at right angles to the plane of both (phi_d = 90 degrees;
// Rusinkiewicz 1998). If both angles are below 90 degrees, both directions are above the surface.
struct SliceDirections {
  Vec3d to_light, to_view;
};
SliceDirections DirectionsOfSlice(double theta_h_deg, double theta_d_deg);

// For each material, the BRDF over theta_h and theta_d as colours, on a common scale, which values
// for grazing light may exceed (Burley 2012, figure 3). The highlight is at the left, Fresnel's
// effect at the top, grazing retroreflection at the right.
std::vector<Plot> SlicePlots(const std::vector<NamedMaterial>& materials, ColorChannel channel);

}  // namespace nacre
