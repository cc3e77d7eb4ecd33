// SPDX-License-Identifier: Apache-2.0
// study/reflection.h: reflection models evaluated one pair of directions at a time by the kernels
// that render; in double, from the scalar terms of brdf/, by shading/scalar_material.h.
#pragma once

#include "shading/scalar_material.h"

namespace nacre {

// What the active SIMD target's kernel makes of Reflect.
Reflection ReflectByKernel(const ShadingMaterial& material, const Vec3d& normal,
                           const Vec3d& to_light, const Vec3d& to_view);

// A direction in the plane of incidence, with the normal (0, 0, 1): `degrees` from it, positive
// towards +x.
Vec3d DirectionAt(double degrees);

}  // namespace nacre
