// SPDX-License-Identifier: Apache-2.0
// shading/scalar_sample.h: samples directions to light from all components of a prepared material,
// in double and for one viewer, for measuring materials, not for rendering. Renders sample the
// specular and the diffuse component separately (lobe_sample.h).
#pragma once

#include "shading/material.h"

namespace nacre {

// SampleReflection samples a direction to light with u0 and u1 in [0, 1), roughly in proportion to
// the light that the material reflects from there. ReflectionPdf is its pdf per solid angle.
// Directions below the surface count as lost light. A perfect mirror's lobe is left out, as by
// Reflect (scalar_material.h).
Vec3d SampleReflection(const ShadingMaterial& material, const Vec3d& normal, const Vec3d& to_view,
                       double u0, double u1);
double ReflectionPdf(const ShadingMaterial& material, const Vec3d& normal, const Vec3d& to_view,
                     const Vec3d& to_light);

}  // namespace nacre
