// SPDX-License-Identifier: Apache-2.0
// light/ltc.h: linearly transformed cosines (Heitz, Dupuy, Hill and Neubelt 2016): about a GGX lobe
// and what its surface faces, as a clamped cosine about z whose directions a matrix has mapped. So
// the part of a lobe that a polygon fills is the irradiance of the polygon mapped back. Matrices
// are fitted by scripts/fit_ltc.py, which tells how far they are off.
//
// z is the normal, and the viewer is in the plane of x and z, where x >= 0.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "base/vec.h"

namespace nacre {

inline constexpr double kLeastLtcRoughness = 0.1;
inline constexpr size_t kLtcRoughnesses = 19;  // evenly from there to 1
inline constexpr size_t kLtcViews = 32;        // evenly in sqrt(1 - n.v)

// What maps back, but for a factor: ((xx, 0, xz), (0, 1, 0), (zx, 0, zz)).
struct LtcNumbers {
  float xx, xz, zx, zz;

  template <typename Real>
  Imath::Vec3<Real> Apply(const Imath::Vec3<Real>& v) const {
    return {xx * v.x + xz * v.z, v.y, zx * v.x + zz * v.z};
  }
};

// Of one roughness.
using LtcRow = std::array<LtcNumbers, kLtcViews>;

// The lobe for F = 1, and for F = (1 - v.h)^5, which has its light nearer to the horizon: Schlick's
// curve is a mixture of both.
struct LtcRows {
  LtcRow one, schlick;
};

// roughness in [kLeastLtcRoughness, 1]: linear between the tables'.
LtcRows MakeLtcRows(double roughness);

inline LtcNumbers Blend(const LtcNumbers& a, const LtcNumbers& b, float t) {
  return {a.xx + (b.xx - a.xx) * t, a.xz + (b.xz - a.xz) * t, a.zx + (b.zx - a.zx) * t,
          a.zz + (b.zz - a.zz) * t};
}

// Linear between the row's views.
inline LtcNumbers AtView(const LtcRow& row, float n_dot_v) {
  constexpr float kLast = kLtcViews - 1;
  const float at = std::sqrt(std::clamp(1 - n_dot_v, 0.0f, 1.0f)) * kLast;
  const size_t i = std::min(static_cast<size_t>(at), kLtcViews - 2);
  return Blend(row[i], row[i + 1], at - static_cast<float>(i));
}

}  // namespace nacre
