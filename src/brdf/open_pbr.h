// SPDX-License-Identifier: Apache-2.0
// brdf/open_pbr.h: terms of OpenPBR Surface 1.1.1 that no other model has: the index under
// specular_weight, Fresnel's curve of a dielectric below a coat, and what a coat does to the
// roughness, brightness and colour of what lies below. Scalar alone: of each material, or of the
// coat of a hit.
//
// Section names in brackets are those of the specification. n_a, n_b and n_c are the indices of
// air, base and coat.
#pragma once

#include <algorithm>
#include <cmath>

#include "brdf/fresnel.h"

namespace nacre {

// The index of an interface whose reflectance at normal incidence is `weight` times that of the
// relative index `eta` [Dielectric base]. The reflectance stays below 1, where the index would be
// infinite; the limit is that of the reference graph.
inline constexpr double kMostWeightedReflectance = 0.99999;
template <typename Real>
Real WeightedIndex(Real eta, Real weight) {
  const Real f0 = std::min(weight * FresnelF0(eta, Real(0)), Real(kMostWeightedReflectance));
  const Real root = std::copysign(std::sqrt(std::max(f0, Real(0))), eta - 1);
  return (1 + root) / (1 - root);
}

// The roughness below a coat of roughness c that covers all of the base, of roughness r [Coat /
// Roughening]: the variances of the slopes add up, r^4 + factor c^4, of which at most 1 is left.
template <typename Real>
Real RoughnessBelowCoat(Real r, Real c, Real factor) {
  const auto power4 = [](Real x) { return x * x * x * x; };
  return std::pow(std::min(power4(r) + factor * power4(c), Real(1)), Real(0.25));
}

// The same by issue 261 of the specification, a fit to simulated layers, n being the coat's index.
// It roughens below a smooth coat, too, and its alpha is at most 0.85.
template <typename Real>
Real FittedRoughnessBelowCoat(Real r, Real c, Real n) {
  const Real by_base = n * r * r;
  const Real by_coat = Real(1.05) * (n - 1) * std::sqrt(1 + n * n) / n * c * c;
  const Real most = Real(0.85);
  return std::sqrt(most * std::tanh(std::sqrt(by_base * by_base + by_coat * by_coat) / most));
}

// The fraction of diffuse light that is reflected back to the base from inside a smooth interface
// of index n, of which `average` is the mean reflectance from outside [Coat / Darkening, K_r].
template <typename Real>
Real InternalDiffuseReflectance(Real average, Real n) {
  return 1 - (1 - average) / (n * n);
}

// The factor by which a base of the albedo `base` is darkened below a coat that sends the fraction
// `k` of its light back to it [Coat / Darkening, Delta]. `crossing` is the transmittance of the
// coat's medium there and back. A white base is not darkened, also where the coat lets nothing
// through (k = 1).
template <typename Real>
Real CoatDarkeningFactor(Real base, Real k, Real crossing = 1) {
  const Real rest = 1 - base * k * crossing;
  return rest > 0 ? (1 - k) / rest : Real(1);
}

// The cosine of a direction that is refracted into a coat of index 1 / inverse_eta; 0 where a coat
// that is thinner than air reflects all light.
template <typename Real>
Real RefractedCosine(Real cosine, Real inverse_eta) {
  const Real sin2 = (1 - cosine) * (1 + cosine) * inverse_eta * inverse_eta;
  return std::sqrt(std::max(1 - sin2, Real(0)));
}

// One crossing of a coat whose transmittance for both crossings at normal incidence is `color`: the
// square root of that to the power of the path's length [Coat / View-dependent absorption].
// `refracted` is RefractedCosine. A path without end absorbs all that a coat of any colour absorbs.
template <typename Real>
Real CoatCrossing(Real color, Real refracted) {
  if (color >= 1) return 1;
  return refracted > 0 ? std::pow(color, 1 / (2 * refracted)) : Real(0);
}

}  // namespace nacre
