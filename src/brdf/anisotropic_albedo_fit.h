// SPDX-License-Identifier: Apache-2.0
// brdf/anisotropic_albedo_fit.h: polynomials of the anisotropic albedos through values at Chebyshev
// nodes, and the directions that belong to the nodes, for the table's generator and for the fits of
// Fresnel curves.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "base/vec.h"
#include "brdf/anisotropic_albedo_curve.h"
#include "brdf/chebyshev.h"

namespace nacre {

// A ratio of 0 has no directions of its own at the nodes of the second variable: its limit is
// taken.
inline constexpr double kLeastFittedRatio = 1e-5;

// kappa^2 at a value of z.
inline double KappaSquaredAt(const AnisotropicAlbedoShape& shape, double z) {
  const double root = (1 + z) / double{shape.scale};
  const double t = root * root;  // 1 / (6 K + sqrt(1 + 36 K^2)), K^2 = kappa^2 + mean square
  const double k = (1 - t) * (1 + t) / (12 * t);
  return std::max(k * k - double{shape.mean_square}, 0.0);
}

// The direction at which z and the second variable, called share, take the given values.
inline Vec3d DirectionAt(const AnisotropicAlbedoShape& shape, double z, double share) {
  const double kappa2 = KappaSquaredAt(shape, z);
  const double c = (1 + share) * (1 + share) / 4;
  const double cos2 = shape.ratio_squared * (1 - c) / (c + shape.ratio_squared * (1 - c));
  const double x = shape.alpha_x, y = shape.alpha_y;
  const double seen2 = x * x * cos2 + y * y * (1 - cos2);
  const double n = 1 / std::sqrt(1 + kappa2 / seen2);
  const double sin = std::sqrt((1 - n) * (1 + n));
  return {sin * std::sqrt(cos2), sin * std::sqrt(1 - cos2), n};
}

// The width at a value of StreakVariable.
inline double WidthAt(double bend, double streak_variable) {
  const double part = (1 + streak_variable) / 2;
  return bend * part / (1 + bend - part);
}

using KappaValues = std::array<double, kKappaTerms>;

inline KappaPolynomial InterpolateKappa(const KappaValues& values) {
  KappaPolynomial polynomial;
  const KappaValues exact = InterpolateChebyshev(values);
  for (size_t i = 0; i < kKappaTerms; ++i) polynomial[i] = static_cast<float>(exact[i]);
  return polynomial;
}

// The polynomial of values at the nodes of both variables, by the second one's index first.
template <size_t kTerms>
std::array<KappaPolynomial, kTerms> InterpolateKappa(
    const std::array<KappaValues, kTerms>& values) {
  std::array<KappaValues, kTerms> by_power{};
  for (size_t k = 0; k < kKappaTerms; ++k) {
    std::array<double, kTerms> column;
    for (size_t j = 0; j < kTerms; ++j) column[j] = values[j][k];
    column = InterpolateChebyshev(column);
    for (size_t j = 0; j < kTerms; ++j) by_power[j][k] = column[j];
  }
  std::array<KappaPolynomial, kTerms> polynomial;
  for (size_t j = 0; j < kTerms; ++j) polynomial[j] = InterpolateKappa(by_power[j]);
  return polynomial;
}

}  // namespace nacre
