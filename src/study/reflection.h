// SPDX-License-Identifier: Apache-2.0
// study/reflection.h: evaluates reflection models for single pairs of directions with the
// renderer's SIMD kernels. For double precision, see shading/scalar_bsdf.h.
#pragma once

#include "shading/scalar_bsdf.h"

namespace nacre {

// Evaluates like Reflect, but by the kernel of the active SIMD target.
Reflection ReflectByKernel(const ShadingMaterial& material, const Vec3d& normal,
                           const Vec3d& to_light, const Vec3d& to_view);

// A direction in the plane of incidence, at `degrees` from the normal (0, 0, 1), positive towards
// +x.
Vec3d DirectionAt(double degrees);

}  // namespace nacre
