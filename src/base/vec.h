// SPDX-License-Identifier: Apache-2.0
// base/vec.h: the vector types, Imath's, under short names.
#pragma once

#include <Imath/ImathColor.h>
#include <Imath/ImathMatrix.h>
#include <Imath/ImathVec.h>

namespace nacre {

using Vec2d = Imath::V2d;
using Vec3d = Imath::V3d;
using Vec3f = Imath::V3f;

// Linear radiometric or reflectance values, Rec. 709 primaries. Double in the scene, so that
// products of material and light are rounded to float once, in the kernels' uniforms.
using Rgb = Imath::Color3<double>;

inline bool IsBlack(const Rgb& color) { return color.x == 0 && color.y == 0 && color.z == 0; }

}  // namespace nacre
