// SPDX-License-Identifier: Apache-2.0
// shading/scalar_material.h: what a prepared material reflects, in double, for one light and one
// viewer: for measuring materials, not for rendering. The kernels compute the same in float.
#pragma once

#include "shading/material.h"

namespace nacre {

// Radiance towards the viewer per perpendicular irradiance of the light, f n.l: for every model
// finite where the BRDF f is not.
struct Reflection {
  Rgb diffuse{0, 0, 0}, specular{0, 0, 0};

  Rgb Sum() const { return diffuse + specular; }
};

// Of unit vectors; black where light or viewer is not above the surface. A delta lobe shows
// nothing; neither do emission, ambient light and maps.
Reflection Reflect(const ShadingMaterial& material, const Vec3d& normal, const Vec3d& to_light,
                   const Vec3d& to_view);

// Fresnel's term of the model's curve, at cosine v.h; of a mix of dielectric and metal the mix.
Rgb FresnelOf(const MicrofacetModel& model, double v_dot_h, double one_minus_vh);

// Turquin's compensation scales a lobe by 1 + F0 (1 / E - 1), of a mix each of the two lobes by its
// own: the Fresnel term becomes FresnelOf + (1 / E - 1) TurquinTerm, where this is F0 F, mixed.
Rgb TurquinTerm(const MicrofacetModel& model, double v_dot_h, double one_minus_vh);

// G / (4 n.l n.v) in the model's form.
double VisibilityOf(const MicrofacetModel& model, double n_dot_l, double n_dot_v);

}  // namespace nacre
