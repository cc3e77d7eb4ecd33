// SPDX-License-Identifier: Apache-2.0
// shading/scalar_sample.h: directions to light by all that a prepared material reflects, in double
// and of one viewer: for measuring materials, not for rendering. Renders sample the specular and
// the diffuse component apart (lobe_sample.h).
#pragma once

#include "shading/material.h"

namespace nacre {

// A direction to light by u0 and u1 in [0, 1), chosen about as often as the material reflects light
// from there, and the pdf of that per solid angle. Directions below the surface are light that is
// lost. A perfect mirror's lobe is left out, as by Reflect (scalar_material.h).
Vec3d SampleReflection(const ShadingMaterial& material, const Vec3d& normal, const Vec3d& to_view,
                       double u0, double u1);
double ReflectionPdf(const ShadingMaterial& material, const Vec3d& normal, const Vec3d& to_view,
                     const Vec3d& to_light);

}  // namespace nacre
