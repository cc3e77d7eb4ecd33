// SPDX-License-Identifier: Apache-2.0
// shading/scalar_material.h: the reflection of a prepared material for one light and one viewer, in
// double, for measuring materials, not for rendering. The kernels compute the same in float.
#pragma once

#include "shading/material.h"
#include "shading/reflection.h"

namespace nacre {

// All directions are unit vectors. The result is black where light or viewer is not above the
// surface. Delta lobes, emission, ambient light and maps are left out.
Reflection Reflect(const ShadingMaterial& material, const Vec3d& normal, const Vec3d& to_light,
                   const Vec3d& to_view);

// Fresnel's term of the model's curve at cosine v.h; for a mix of dielectric and metal, the mix.
Rgb FresnelOf(const MicrofacetModel& model, double v_dot_h, double one_minus_vh);

// F0 F, mixed for dielectric and metal. Turquin's compensation scales a lobe by 1 + F0 (1 / E - 1),
// and each of the two lobes of a mix by its own factor, so the Fresnel term becomes FresnelOf +
// (1 / E - 1) TurquinTerm.
Rgb TurquinTerm(const MicrofacetModel& model, double v_dot_h, double one_minus_vh);

// The visibility term G / (4 n.l n.v) in the model's form.
double VisibilityOf(const MicrofacetModel& model, double n_dot_l, double n_dot_v);

}  // namespace nacre
