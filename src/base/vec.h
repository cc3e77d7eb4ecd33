// SPDX-License-Identifier: Apache-2.0
// base/vec.h: the vector types, Imath's, under short names.
#pragma once

#include <algorithm>
#include <cmath>

#include <Imath/ImathColor.h>
#include <Imath/ImathMatrix.h>
#include <Imath/ImathVec.h>

namespace nacre {

using Vec2d = Imath::V2d;
using Vec3d = Imath::V3d;
using Vec3f = Imath::V3f;

// |v|_1, used in bounds on rounding errors of coordinates.
inline double SumOfAbs(const Vec3d& v) { return std::abs(v.x) + std::abs(v.y) + std::abs(v.z); }

// Linear radiometric or reflectance values, Rec. 709 primaries. Double in the scene, so that
// products of material and light are rounded to float once, in the kernels' uniforms.
using Rgb = Imath::Color3<double>;

inline bool IsBlack(const Rgb& color) { return color.x == 0 && color.y == 0 && color.z == 0; }

inline double LargestChannel(const Rgb& color) { return std::max({color.x, color.y, color.z}); }

// The colour whose channel c is of_channel(c).
template <class OfChannel>
Rgb MakeRgb(const OfChannel& of_channel) {
  return {of_channel(0), of_channel(1), of_channel(2)};
}

}  // namespace nacre
