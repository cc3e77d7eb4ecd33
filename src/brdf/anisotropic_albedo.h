// SPDX-License-Identifier: Apache-2.0
// brdf/anisotropic_albedo.h: directional albedos of the anisotropic GGX lobe at render time, for
// Smith's two forms of shadowing. SIMD twin: anisotropic_albedo-inl.h. They are fitted to the
// quadrature of brdf/anisotropic_albedo_integral.h.
//
// A fit holds the polynomials of one pair of alphas. A material whose alphas are constant makes one
// fit; hits whose alphas come from maps make one each, of 16 entries of a table, in half a
// microsecond.
//
// Worst errors found in float, over alphas along the tangent up to sqrt(2), ratios in [0, 1], n.v
// in [1e-4, 1] and all azimuths: E 7e-4, relative to itself, so that white furnaces of conductors
// close within that, with Turquin's factor as with Kulla and Conty's lobe; B 9e-4.
#pragma once

#include <algorithm>

#include "brdf/anisotropic_albedo_curve.h"
#include "brdf/fresnel.h"

namespace nacre {

struct AnisotropicAlbedoFit {
  AnisotropicAlbedoShape shape;
  SharePolynomial loss{};
  SharePolynomial schlick{};
  WidthPolynomial streak{};
  double e_average = 1;        // the mean of E over the hemisphere, weighted by n.l
  double schlick_average = 0;  // that of B
};

// shadowing is kHeightCorrelated or kSeparable. alpha.x >= alpha.y, as all mappings of
// brdf/ggx_anisotropic.h have it; alphas above kLargestAlbedoAlpha count as that, with the same
// ratio. The fit is continuous in both.
AnisotropicAlbedoFit MakeAnisotropicAlbedoFit(Shadowing shadowing, const GgxAlphas<double>& alpha);

// 1 - E: the light that a lobe with F = 1 loses because it would have to bounce again, by the
// direction's cosines to normal, tangent and bitangent. An n.x below 0 counts as 0.
template <typename Real>
Real AlbedoLoss(const AnisotropicAlbedoFit& fit, const AnisotropicAlbedoVariables<Real>& x) {
  const Real loss = x.factor * EvaluatePolynomial(fit.loss, x.z, x.share);
  return std::min(std::max(loss, Real(0)), Real(1));
}

// E: the albedo for F = 1.
template <typename Real>
Real AlbedoOne(const AnisotropicAlbedoFit& fit, const AnisotropicAlbedoVariables<Real>& x) {
  return 1 - AlbedoLoss(fit, x);
}

// B: the albedo for F = (1 - v.h)^5, which is (1 - n.v)^5 E of a mirror, and what the lobe's width
// adds. Schlick's albedo is F0 E + (1 - F0) B.
//
// Where ay = 0, half vectors lie in the plane of n and t, and v.h is v's length in this plane, w,
// times a cosine that depends on kappa alone: B is a polynomial in w of degree 5, whose
// coefficients are functions of z. This part is taken with w = x.width for every ay, and is 0 for
// w = 0, where B is E. What is left has a polynomial like that of E.
template <typename Real>
Real AlbedoSchlick(const AnisotropicAlbedoFit& fit, Real albedo_one,
                   const AnisotropicAlbedoVariables<Real>& x) {
  const Real mirror = Power5(1 - x.n_dot_x) * albedo_one;
  const Real streak = x.width * EvaluatePolynomial(fit.streak, x.z, x.width);
  const Real albedo = mirror + streak + x.rest * EvaluatePolynomial(fit.schlick, x.z, x.share);
  return std::min(std::max(albedo, Real(0)), Real(1));
}

}  // namespace nacre
