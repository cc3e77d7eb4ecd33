// SPDX-License-Identifier: Apache-2.0
// brdf/eon.h: EON, diffuse reflection of rough surfaces that keeps energy and is reciprocal.
// Portsmouth, Kutz and Hill 2025, "EON: A Practical Energy-Preserving Rough Diffuse BRDF", JCGT
// 14(1). SIMD twin: eon-inl.h.
//
// EON is Fujii's form of Oren and Nayar's model, which loses energy, plus a lobe for the light that
// it loses: the reciprocal product of its losses in the two directions (Kelemen and Szirmay-Kalos
// 2001). Here it has the exact directional albedo, so that a white surface reflects all light, at
// every roughness and angle. At roughness 0 it is Lambert's model. The roughness is the model's
// own, in [0, 1].
#pragma once

#include <algorithm>
#include <cmath>

#include "brdf/angles.h"

namespace nacre {

// Fujii's normalisation is EonScale = 1 / (1 + (1/2 - 2 / 3 pi) roughness), and the mean albedo of
// the single reflection is EonScale (1 + (2/3 - 28 / 15 pi) roughness).
inline constexpr double kEonAlbedo = 0.5 - 2 / (3 * M_PI);
inline constexpr double kEonMeanAlbedo = 2.0 / 3 - 28 / (15 * M_PI);

template <typename Real>
Real EonScale(Real roughness) {
  return 1 / (1 + static_cast<Real>(kEonAlbedo) * roughness);
}

// The directional albedo of the single reflection is scale (1 + roughness g / pi), 1 at grazing
// angles. EonLoss is one minus that, divided by scale and roughness: kEonAlbedo - g / pi. With
// (1 - sin^3) / cos = cos (1 + sin + sin^2) / (1 + sin), nothing is divided by the cosine.
template <typename Real>
Real EonLoss(Real cos) {
  const Real sin = std::sqrt(std::max((1 - cos) * (1 + cos), static_cast<Real>(0)));
  const Real angle = std::atan2(sin, cos);
  const Real tangential = cos * (1 + sin + sin * sin) / (1 + sin) - 1;
  const Real g = sin * (angle - sin * cos + 2 * tangential / 3);
  // The loss is 0 at grazing angles, where rounding may make it negative.
  return std::max<Real>(static_cast<Real>(kEonAlbedo) - g / static_cast<Real>(M_PI), 0);
}

// Single reflection, per unit of albedo. l_dot_v is the cosine between light and viewer.
template <typename Real>
Real EonSingle(Real n_dot_l, Real n_dot_v, Real l_dot_v, Real roughness) {
  const Real s = l_dot_v - n_dot_l * n_dot_v;
  const Real s_over_t = s > 0 ? s / std::max(n_dot_l, n_dot_v) : s;
  // Opposite directions at roughness 1 give 0, which rounding may make negative.
  const Real spread = std::max<Real>(1 + roughness * s_over_t, 0);
  return EonScale(roughness) * spread / static_cast<Real>(M_PI);
}

// Multiple reflection, per unit of EonMultipleAlbedo: the product of the losses in both directions
// over their mean. All factors of roughness and scale but one cancel.
template <typename Real>
Real EonMultiple(Real n_dot_l, Real n_dot_v, Real roughness) {
  const Real mean_loss = static_cast<Real>(kEonAlbedo - kEonMeanAlbedo);
  return EonScale(roughness) * roughness * EonLoss(n_dot_l) * EonLoss(n_dot_v) /
         (mean_loss * static_cast<Real>(M_PI));
}

// EonMultipleAlbedo over the albedo.
template <typename Real>
Real EonMultipleRatio(Real albedo, Real roughness) {
  const Real mean = EonScale(roughness) * (1 + static_cast<Real>(kEonMeanAlbedo) * roughness);
  return albedo * mean / (1 - albedo * (1 - mean));
}

template <typename Real>
Real EonMultipleAlbedo(Real albedo, Real roughness) {
  return albedo * EonMultipleRatio(albedo, roughness);
}

// The BRDF of one channel. 0 unless light and viewer are above the surface.
template <typename Real>
Real Eon(const Angles<Real>& a, Real albedo, Real roughness) {
  if (!(a.n_dot_l > 0) || !(a.n_dot_v > 0)) return 0;
  const Real l_dot_v = 1 - a.lv_squared / 2;
  return albedo * EonSingle(a.n_dot_l, a.n_dot_v, l_dot_v, roughness) +
         EonMultipleAlbedo(albedo, roughness) * EonMultiple(a.n_dot_l, a.n_dot_v, roughness);
}

}  // namespace nacre
