// SPDX-License-Identifier: Apache-2.0
// brdf/albedo_curve.h: the form of the run-time albedos (brdf/albedo.h): which functions of n.v
// they are polynomials in. SIMD twin: albedo-inl.h.
//
// An albedo of a lobe of width alpha has a boundary layer: it bends where n.v is about alpha, and
// its slope has a logarithm at 0. The angle theta with tan(theta) = n.v / 6 alpha turns the layer
// into an ordinary curve, tan(theta / 2) does so without trigonometry, and the square root of that
// tames the logarithm: a polynomial in z of degree 17 has errors of 2e-5 at every alpha.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "brdf/ggx.h"

namespace nacre {

inline constexpr int kAlbedoTerms = 18;
inline constexpr float kAlbedoOffsetOverAlpha = 6;  // AlbedoShape::offset over alpha

// Below this n.v, albedos are those at this n.v: its square must not underflow.
inline constexpr double kLeastAlbedoCosine = 1e-15;

// The function of n.v by which the polynomial of the curve for F = 1 is multiplied: AlbedoFactor.
enum class AlbedoForm : uint8_t {
  kLossSquared,  // the curve is 1 - E, which falls as (alpha / n.v)^2: Smith's forms
  kLossLinear,   // the curve is 1 - E, which falls as alpha / n.v: kSchlickIbl
  kMasked,       // the curve is E, which is nearly 0 at grazing angles: kSchlickDirect
};

inline AlbedoForm AlbedoFormOf(Shadowing shadowing) {
  if (shadowing == Shadowing::kSchlickDirect) return AlbedoForm::kMasked;
  return shadowing == Shadowing::kSchlickIbl ? AlbedoForm::kLossLinear : AlbedoForm::kLossSquared;
}

// The parameters of a curve's variable and factors besides n.v. `offset` is 0 for a mirror.
struct AlbedoShape {
  float offset = 0;     // kAlbedoOffsetOverAlpha alpha
  float scale = 2;      // multiplies sqrt(tan(theta / 2)), so that z is 1 at n.v = 1
  float k = 0;          // kMasked: Schlick's k
  float softening = 0;  // kMasked: see AlbedoMasking
  AlbedoForm form = AlbedoForm::kLossSquared;
};

AlbedoShape MakeAlbedoShape(Shadowing shadowing, double roughness);

// A polynomial in z, lowest power first.
using AlbedoPolynomial = std::array<float, kAlbedoTerms>;

// The functions of n.v in which the curves are expressed.
template <typename Real>
struct AlbedoVariables {
  Real z;        // in [-1, 1]
  Real n_dot_v;  // in (0, 1]
  // 1 at n.v = 0, and about 2 offset / n.v far above the boundary layer. The loss 1 - E has this
  // shape, or its square for Smith's forms, which lose alpha^2 (1 + mu^2) / 2 mu^2.
  Real layer;
};

template <typename Real>
AlbedoVariables<Real> ComputeAlbedoVariables(const AlbedoShape& shape, Real n_dot_v) {
  const Real mu = std::min(std::max(n_dot_v, static_cast<Real>(kLeastAlbedoCosine)), Real(1));
  const Real offset = shape.offset;
  const Real inverse = 1 / (offset + std::sqrt(mu * mu + offset * offset));
  return {shape.scale * std::sqrt(mu * inverse) - 1, mu, 2 * offset * inverse};
}

// kSchlickDirect's masking at alpha = 0, (mu / (mu (1 - k) + k))^2, with the light's mu softened by
// the lobe's width. Because E is used as a divisor, curves of this form are relative to it.
template <typename Real>
Real AlbedoMasking(const AlbedoShape& shape, Real n_dot_v) {
  const Real k = shape.k;
  const Real y2 = n_dot_v * n_dot_v + shape.softening;
  const Real y = std::sqrt(y2);
  return y2 / ((n_dot_v * (1 - k) + k) * (y * (1 - k) + k));
}

template <typename Real>
Real AlbedoFactor(const AlbedoShape& shape, const AlbedoVariables<Real>& x) {
  switch (shape.form) {
    case AlbedoForm::kMasked:
      return AlbedoMasking(shape, x.n_dot_v);
    case AlbedoForm::kLossLinear:
      // 12 times alpha (1 - mu) / mu + alpha^2; the last summand keeps wide lobes smooth.
      return x.layer * (1 - x.n_dot_v + x.layer * (Real(1) / 12 + shape.offset / 4));
    case AlbedoForm::kLossSquared:
      break;
  }
  return (1 + x.n_dot_v * x.n_dot_v) * x.layer * x.layer;
}

template <typename Real>
Real EvaluateAlbedoPolynomial(const AlbedoPolynomial& polynomial, Real z) {
  Real sum = polynomial[kAlbedoTerms - 1];
  for (int i = kAlbedoTerms - 2; i >= 0; --i) sum = sum * z + polynomial[static_cast<size_t>(i)];
  return sum;
}

// The n.v at which z is the i-th Chebyshev node.
double AlbedoNodeCosine(const AlbedoShape& shape, int i);

// The polynomial that takes the given values at the Chebyshev nodes.
std::array<double, kAlbedoTerms> InterpolateAlbedo(const std::array<double, kAlbedoTerms>& values);

}  // namespace nacre
