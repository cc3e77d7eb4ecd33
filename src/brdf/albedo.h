// SPDX-License-Identifier: Apache-2.0
// brdf/albedo.h: directional albedos of the GGX lobe at render time: the fraction of light that a
// lobe reflects in all directions, as a function of n.v. SIMD twin: albedo-inl.h. They are fitted
// to the quadratures of brdf/albedo_integral.h.
//
// A material's fit is a handful of coefficients, so that a vector of hits evaluates polynomials and
// needs no gathers. Worst errors found in float, over roughness in [0, 1] and n.v in [1e-4, 1]:
// E 4e-5 (relative 1e-4), B and a dielectric's albedo 2e-5. Below n.v = 1e-4 the same holds, except
// that kSchlickDirect's E, which is nearly 0 there, has a relative error of up to 0.7 %.
#pragma once

#include <memory>
#include <vector>

#include "brdf/albedo_curve.h"
#include "brdf/fresnel.h"
#include "brdf/fresnel_function.h"
#include "brdf/fresnel_table.h"

namespace nacre {

// The albedos of one roughness and shadowing form for F = 1 and for F = (1 - v.h)^5.
struct AlbedoFit {
  AlbedoShape shape;
  AlbedoPolynomial one{};
  AlbedoPolynomial schlick{};
  double e_average = 1;        // 2 int E mu dmu
  double schlick_average = 0;  // 2 int B mu dmu
};

// roughness is in [0, 1]; the fit is continuous in it.
AlbedoFit MakeAlbedoFit(Shadowing shadowing, double roughness);

// MakeAlbedoFit without the averages, whose logarithm is most of the work.
AlbedoFit BlendAlbedoCurves(Shadowing shadowing, double roughness);

// An AlbedoFit with a third curve, for the exact Fresnel curve of a dielectric, coated or not.
struct FresnelAlbedoFit {
  AlbedoFit lobe;
  AlbedoPolynomial fresnel{};
  CoatedDielectric<double> curve;
  // Set where light arrives from the optically denser side, of the base or of a coat: the albedo
  // against n.v as a fraction 1 - loss of that for F = 1. Total reflection sets in at a corner that
  // the polynomial cannot follow. Errors are up to 1e-3, and 2e-3 where there are two corners.
  std::shared_ptr<const FresnelTable> corner;
  double average = 0;  // 2 int of the albedo mu dmu
};

// The third curve for any Fresnel curve: what the lobe's width adds to a mirror's albedo.
AlbedoPolynomial FitFresnelAlbedo(Shadowing shadowing, double roughness, const AlbedoFit& lobe,
                                  const FresnelFunction& curve);

// Computed by quadrature, in about half a millisecond; with a corner, in tens to hundreds.
FresnelAlbedoFit MakeDielectricAlbedoFit(Shadowing shadowing, double roughness,
                                         const CoatedDielectric<double>& curve);

// The third curve of FresnelAlbedoFit, and its average, for one curve at all roughnesses of
// brdf/albedo_table.h. Corners are not known: eta >= 1, or errors are up to a half. Hits that have
// a roughness each blend theirs from four of these. MakeDielectricCurves takes some tens of
// milliseconds.
struct DielectricCurves {
  std::vector<AlbedoPolynomial> fresnel;
  std::vector<double> average;
};
DielectricCurves MakeDielectricCurves(Shadowing shadowing, const CoatedDielectric<double>& curve);

// The third curve of one roughness, and its average.
struct DielectricCurve {
  AlbedoPolynomial fresnel{};
  double average = 0;
};
DielectricCurve BlendDielectricCurves(const DielectricCurves& curves, double roughness);

// 1 - E: the light that a lobe with F = 1 loses because it would have to bounce again. Its relative
// error is small, except for kSchlickDirect, although for smooth surfaces it is far below the
// rounding error of E.
template <typename Real>
Real AlbedoLoss(const AlbedoFit& fit, Real n_dot_v) {
  const auto x = ComputeAlbedoVariables(fit.shape, n_dot_v);
  const Real product = AlbedoFactor(fit.shape, x) * EvaluateAlbedoPolynomial(fit.one, x.z);
  return std::max(fit.shape.form == AlbedoForm::kMasked ? 1 - product : product, Real(0));
}

// E: the albedo for F = 1, in (0, 1].
template <typename Real>
Real AlbedoOne(const AlbedoFit& fit, Real n_dot_v) {
  if (fit.shape.form != AlbedoForm::kMasked) return 1 - AlbedoLoss(fit, n_dot_v);
  const auto x = ComputeAlbedoVariables(fit.shape, n_dot_v);
  return std::min(AlbedoMasking(fit.shape, x.n_dot_v) * EvaluateAlbedoPolynomial(fit.one, x.z),
                  Real(1));
}

// The albedo for a Fresnel curve, from `mirror`, the curve's value at v.h = n.v, which would be a
// mirror's albedo, and a polynomial for the effect of the lobe's width.
template <typename Real>
Real AlbedoNearMirror(const AlbedoFit& fit, const AlbedoPolynomial& polynomial, Real mirror,
                      Real n_dot_v) {
  const auto x = ComputeAlbedoVariables(fit.shape, n_dot_v);
  const Real masking =
      fit.shape.form == AlbedoForm::kMasked ? AlbedoMasking(fit.shape, x.n_dot_v) : Real(1);
  const Real albedo =
      mirror * AlbedoOne(fit, n_dot_v) + masking * EvaluateAlbedoPolynomial(polynomial, x.z);
  return std::min(std::max(albedo, Real(0)), Real(1));
}

// B: the albedo for F = (1 - v.h)^5. Schlick's albedo is F0 E + (1 - F0) B.
template <typename Real>
Real AlbedoSchlick(const AlbedoFit& fit, Real n_dot_v) {
  const Real mu = std::min(std::max(n_dot_v, Real(0)), Real(1));
  return AlbedoNearMirror(fit, fit.schlick, Power5(1 - mu), mu);
}

// The albedo for the exact Fresnel curve of the fit.
template <typename Real>
Real AlbedoFresnel(const FresnelAlbedoFit& fit, Real n_dot_v) {
  if (fit.corner) {
    return AlbedoOne(fit.lobe, n_dot_v) * (1 - FresnelTableLoss(*fit.corner, n_dot_v)[0]);
  }
  const Real mu = std::min(std::max(n_dot_v, static_cast<Real>(kLeastAlbedoCosine)), Real(1));
  const CoatedDielectric<Real> curve{
      static_cast<Real>(fit.curve.eta), static_cast<Real>(fit.curve.coat),
      static_cast<Real>(fit.curve.eta_in_coat), static_cast<Real>(fit.curve.inverse_coat_eta)};
  const Real mirror = FresnelCoatedDielectric(mu, 1 - mu, curve);
  return AlbedoNearMirror(fit.lobe, fit.fresnel, mirror, n_dot_v);
}

}  // namespace nacre
