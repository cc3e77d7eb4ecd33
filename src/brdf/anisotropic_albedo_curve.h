// SPDX-License-Identifier: Apache-2.0
// brdf/anisotropic_albedo_curve.h: the form of the anisotropic albedos of
// brdf/anisotropic_albedo.h: which functions of a direction they are polynomials in. SIMD twin:
// anisotropic_albedo-inl.h.
//
// A direction is given by its cosines n, t and b to normal, tangent and bitangent. With
// rho^2 = (ax t)^2 + (ay b)^2, Smith's terms depend on it by kappa = rho / n and by the bitangent's
// share of rho, ay |b| / rho. The albedo for F = 1 is a smooth function of these two, however
// narrow the lobe is and whatever the ratio ay / ax: in the limit ay = 0 it depends on kappa alone.
// (A function of n and the azimuth has a corner at the bitangent, which sharpens as ay falls, and
// the albedo of an isotropic lobe with the alpha that the direction sees is wrong by 0.1 at a ratio
// of 0.7 and by 0.5 at a ratio of 0.2.) The first variable is z of brdf/albedo_curve.h with kappa
// in place of alpha tan(theta), which is the same where both alphas are equal.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "brdf/albedo_curve.h"
#include "brdf/ggx_anisotropic.h"

namespace nacre {

// Terms in z and in the bitangent's share; and of the limit ay = 0, powers of the width from 1 on.
inline constexpr int kKappaTerms = 14;
inline constexpr int kShareTerms = 7;
inline constexpr int kWidthTerms = 5;
// Terms in the StreakVariable of an exact Fresnel curve.
inline constexpr int kStreakTerms = 8;

// The largest alpha of the fit: that of OpenPBR at roughness 1 and anisotropy 1.
inline constexpr double kLargestAlbedoAlpha = 1.4142135623730951;

// Powers of z, lowest first, for each power of the second variable.
using KappaPolynomial = std::array<float, kKappaTerms>;
using SharePolynomial = std::array<KappaPolynomial, kShareTerms>;
using WidthPolynomial = std::array<KappaPolynomial, kWidthTerms>;
using StreakPolynomial = std::array<KappaPolynomial, kStreakTerms>;

// The parameters of the variables besides the direction.
struct AnisotropicAlbedoShape {
  float alpha_x = 0, alpha_y = 0;
  float mean_square = 0;    // (ax^2 + ay^2) / 2
  float ratio_squared = 0;  // (ay / ax)^2
  float streak = 0;         // (1 - ay / ax)^3: 0 of isotropic lobes, 1 where ay is 0
  float scale = 2;          // makes z 1 along the normal
};

// alpha.x >= alpha.y, and at most kLargestAlbedoAlpha.
inline AnisotropicAlbedoShape MakeAnisotropicAlbedoShape(const GgxAlphas<double>& alpha) {
  AnisotropicAlbedoShape shape;
  if (!(alpha.x > 0)) return shape;
  const double mean_square = (alpha.x * alpha.x + alpha.y * alpha.y) / 2;
  const double width = 6 * std::sqrt(mean_square);
  shape.alpha_x = static_cast<float>(alpha.x);
  shape.alpha_y = static_cast<float>(alpha.y);
  shape.mean_square = static_cast<float>(mean_square);
  const double ratio = alpha.y / alpha.x;
  shape.ratio_squared = static_cast<float>(ratio * ratio);
  shape.streak = static_cast<float>((1 - ratio) * (1 - ratio) * (1 - ratio));
  shape.scale = static_cast<float>(2 * std::sqrt(width + std::sqrt(1 + width * width)));
  return shape;
}

// The functions of a direction in which the albedos are expressed.
template <typename Real>
struct AnisotropicAlbedoVariables {
  Real z;        // in [-1, 1]
  Real share;    // 2 ay |b| / rho - 1, in [-1, 1]
  Real width;    // sqrt(n^2 + t^2 + (ay / ax)^2 b^2), in [0, 1]: the direction's distance from b
  Real n_dot_x;  // in (0, 1]
  Real factor;   // the loss 1 - E is this times its polynomial
  // What is left of the albedo for Schlick's weight is this times its polynomial. Of streaks little
  // is left apart from the bitangent, where the width is not small.
  Real rest;
};

// kappa^2 + (ax^2 + ay^2) / 2 takes the place of (alpha / n)^2 of the isotropic variables, and
// kappa^2 + ax^2 + ay^2 that of alpha^2 (1 + n^2) / n^2. Both are multiplied by n^2.
template <typename Real>
AnisotropicAlbedoVariables<Real> ComputeAlbedoVariables(const AnisotropicAlbedoShape& shape,
                                                        Real n_dot_x, Real t_dot_x, Real b_dot_x) {
  const Real n = std::min(std::max(n_dot_x, static_cast<Real>(kLeastAlbedoCosine)), Real(1));
  const Real tiny = std::numeric_limits<float>::min();
  if (n_dot_x < 0) {
    // A direction below the surface counts as the grazing one of its azimuth.
    const Real across2 = t_dot_x * t_dot_x + b_dot_x * b_dot_x;
    const Real scale = 1 / std::sqrt(std::max(across2, tiny));
    t_dot_x = across2 > tiny ? t_dot_x * scale : Real(1);
    b_dot_x *= scale;
  }
  const Real x = shape.alpha_x * t_dot_x, y = shape.alpha_y * b_dot_x;
  const Real rho2 = x * x + y * y;
  const Real normal2 = shape.mean_square * (n * n);
  const Real k2 = std::max(rho2 + normal2, tiny);
  const Real k6 = 6 * std::sqrt(k2);
  const Real inverse = 1 / (k6 + std::sqrt(n * n + 36 * k2));
  const Real layer = 2 * k6 * inverse;
  const Real width2 =
      std::min(n * n + t_dot_x * t_dot_x + shape.ratio_squared * (b_dot_x * b_dot_x), Real(1));
  return {shape.scale * std::sqrt(n * inverse) - 1,
          2 * (std::abs(y) / std::sqrt(std::max(rho2, tiny))) - 1,
          std::sqrt(width2),
          n,
          layer * layer * (1 + normal2 / k2),
          1 - shape.streak * width2};
}

// Exact Fresnel curves bend within a cosine of `bend` from grazing incidence, and polynomials in
// the width w would need many terms to follow. In w / (w + bend) they need few.
template <typename Real>
Real StreakVariable(Real bend, Real width) {
  return 2 * (1 + bend) * width / (width + bend) - 1;
}

// Sums of monomials by Horner's rule.
template <typename Real>
Real EvaluatePolynomial(const KappaPolynomial& polynomial, Real z) {
  Real sum = polynomial[kKappaTerms - 1];
  for (int i = kKappaTerms - 2; i >= 0; --i) sum = sum * z + polynomial[static_cast<size_t>(i)];
  return sum;
}
template <typename Real, size_t kTerms>
Real EvaluatePolynomial(const std::array<KappaPolynomial, kTerms>& polynomial, Real z, Real other) {
  Real sum = EvaluatePolynomial(polynomial[kTerms - 1], z);
  for (size_t i = kTerms - 1; i-- > 0;) sum = sum * other + EvaluatePolynomial(polynomial[i], z);
  return sum;
}

}  // namespace nacre
