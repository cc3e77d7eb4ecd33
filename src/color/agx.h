// SPDX-License-Identifier: Apache-2.0
// color/agx.h: the AgX tone operator (Troy Sobotka 2022): its base image formation, without a look.
// SIMD twin: tone-inl.h.
//
// Matrices and range are those that Benjamin Wrensch's "Minimal AgX Implementation" (2023) takes
// from Sobotka's OpenColorIO configuration of that time, with two differences. The curve is
// Sobotka's own sigmoid, not the polynomial that is fitted to it there, which is off by up to 6e-3
// and reaches neither 0 nor 1. And the rows of the inset are scaled to a sum of 1, which the
// published digits miss by 1.4e-4, so that greys stay grey.
#pragma once

#include <algorithm>
#include <cmath>

#include <Imath/ImathColor.h>

namespace nacre {
namespace agx {

struct Matrix {
  double m[3][3];
};
inline constexpr Matrix kPublishedInset = {{
    {0.842479062253094, 0.0784335999999992, 0.0792237451477643},
    {0.0423282422610123, 0.878468636469772, 0.0791661274605434},
    {0.0423756549057051, 0.0784336, 0.879142973793104},
}};
// The inverse of kPublishedInset.
inline constexpr Matrix kPublishedOutset = {{
    {1.19687900512017, -0.0980208811401368, -0.0990297440797205},
    {-0.0528968517574562, 1.15190312990417, -0.0989611768448433},
    {-0.0529716355144438, -0.0980434501171241, 1.15107367264116},
}};

constexpr double InsetRowSum(int i) {
  return kPublishedInset.m[i][0] + kPublishedInset.m[i][1] + kPublishedInset.m[i][2];
}
constexpr Matrix MakeInset() {
  Matrix inset = kPublishedInset;
  for (int i = 0; i < 3; ++i) {
    for (double& value : inset.m[i]) value /= InsetRowSum(i);
  }
  return inset;
}
constexpr Matrix MakeOutset() {
  Matrix outset = kPublishedOutset;
  for (auto& row : outset.m) {
    for (int j = 0; j < 3; ++j) row[j] *= InsetRowSum(j);
  }
  return outset;
}
inline constexpr Matrix kInset = MakeInset();
inline constexpr Matrix kOutset = MakeOutset();

// Logarithmic encoding: 10 stops below middle grey to 6.5 above it.
inline constexpr double kMiddleGrey = 0.18;
inline constexpr double kStopsBelow = 10, kStops = 16.5;
inline constexpr double kDarkest = kMiddleGrey / 1024;                  // 2^-10
inline constexpr double kBrightest = kMiddleGrey * 90.509667991878083;  // 2^6.5
// Sigmoid 1/2 + 2 s (1 + a |s|^p)^(-1/p) about middle grey's place in the encoding, slope 2 there;
// p = 3 below and 3.25 above, where a = 4^p - |end|^-p makes it 0 and 1 at the ends.
inline constexpr double kPivot = kStopsBelow / kStops;
inline constexpr double kToe = 59.507875;              // 4^3 - (33/20)^3
inline constexpr double kShoulder = 69.8627891354554;  // 4^3.25 - (33/13)^3.25
// The curve is made for a display whose light is the encoded value to the power of 2.2.
inline constexpr double kDisplayPower = 2.2;

// Maps t in [0, 1] to [0, 1].
template <typename Real>
Real Sigmoid(Real t) {
  const Real s = t - Real(kPivot);
  if (s < 0) return Real(0.5) + 2 * s / std::cbrt(1 - Real(kToe) * s * s * s);
  const Real base = 1 + Real(kShoulder) * std::pow(s, Real(3.25));
  return Real(0.5) + 2 * s * std::pow(base, Real(-4.0 / 13));
}

template <typename Real>
Imath::Color3<Real> Transform(const Matrix& matrix, const Imath::Color3<Real>& rgb) {
  const auto row = [&](int i) {
    const auto& m = matrix.m[i];
    return Real(m[0]) * rgb.x + Real(m[1]) * rgb.y + Real(m[2]) * rgb.z;
  };
  return {row(0), row(1), row(2)};
}

}  // namespace agx

template <typename Real>
Imath::Color3<Real> ToneAgx(Imath::Color3<Real> rgb) {
  // A channel beyond this limit makes every channel white after the inset. The limit keeps products
  // finite.
  const Real limit = Real(1e6);
  for (int c = 0; c < 3; ++c) rgb[c] = std::min(rgb[c], limit);
  rgb = agx::Transform(agx::kInset, rgb);
  for (int c = 0; c < 3; ++c) {
    const Real x = std::clamp(rgb[c], Real(agx::kDarkest), Real(agx::kBrightest));
    const Real stops = std::log2(x / Real(agx::kMiddleGrey)) + Real(agx::kStopsBelow);
    rgb[c] = agx::Sigmoid(stops / Real(agx::kStops));
  }
  rgb = agx::Transform(agx::kOutset, rgb);
  for (int c = 0; c < 3; ++c) {
    rgb[c] = std::pow(std::clamp(rgb[c], Real(0), Real(1)), Real(agx::kDisplayPower));
  }
  return rgb;
}

}  // namespace nacre
