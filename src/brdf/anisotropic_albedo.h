// SPDX-License-Identifier: Apache-2.0
// brdf/anisotropic_albedo.h: directional albedos of the anisotropic GGX lobe at render time, for
// Smith's two forms of shadowing. SIMD twin: anisotropic_albedo-inl.h. They are fitted to the
// quadrature of brdf/anisotropic_albedo_integral.h.
//
// A fit holds the polynomials of one pair of alphas. A material whose alphas are constant makes one
// fit; hits whose alphas come from maps make one each, of 16 entries of a table, in half a
// microsecond. Exact Fresnel curves are fitted when a material is prepared.
//
// Worst errors found in float, over alphas along the tangent up to sqrt(2), ratios in [0, 1], n.v
// in [1e-4, 1] and all azimuths: E 7e-4, relative to itself, so that white furnaces of conductors
// close within that, with Turquin's factor as with Kulla and Conty's lobe; B 9e-4; exact Fresnel
// curves 7e-4 for indices from 1.1 to 3, coated or not, and 1.1e-3 for 1.01. The worst are wide
// streaks, next to their bitangents. Curves blended by roughness have at most 3e-4 more, and 2e-3
// more for an index of 1.01 and the strongest anisotropies.
#pragma once

#include <algorithm>
#include <functional>
#include <vector>

#include "brdf/anisotropic_albedo_curve.h"
#include "brdf/fresnel.h"
#include "brdf/fresnel_function.h"

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

// What the lobe's width adds to a mirror's albedo for an exact Fresnel curve, in two parts, as for
// Schlick's weight: that which the limit ay = 0 has, too, by StreakVariable, and what is left.
struct AnisotropicFresnelCurve {
  SharePolynomial wider{};
  StreakPolynomial streak{};
  float bend = 1;      // of StreakVariable
  double average = 0;  // the mean of the albedo over the hemisphere, weighted by n.l
};

// The albedo for the curve, from E and from `mirror`, the curve's value at v.h = x.n_dot_x.
template <typename Real>
Real AlbedoFresnel(const AnisotropicFresnelCurve& curve, Real albedo_one, Real mirror,
                   const AnisotropicAlbedoVariables<Real>& x) {
  const Real u = StreakVariable(static_cast<Real>(curve.bend), x.width);
  const Real streak = x.width * EvaluatePolynomial(curve.streak, x.z, u);
  const Real wider = x.rest * EvaluatePolynomial(curve.wider, x.z, x.share);
  return std::min(std::max(mirror * albedo_one + streak + wider, Real(0)), Real(1));
}

// The albedos of one pair of alphas and of a dielectric's exact Fresnel curve, coated or not.
struct AnisotropicFresnelFit {
  AnisotropicAlbedoFit lobe;
  AnisotropicFresnelCurve fresnel;
  CoatedDielectric<double> dielectric;
};

// The cosine within which the curve of a dielectric of this relative index bends most.
double FresnelBend(double eta);

// A curve to be fitted. `bend` is the cosine within which it bends most at grazing incidence.
struct FittedFresnel {
  FresnelFunction curve;
  double bend = 1;
  double average = 0;  // 2 int F c dc, the albedo of a mirror
};

// The curve alone, under the lobe that MakeAnisotropicAlbedoFit makes for these alphas.
AnisotropicFresnelCurve FitAnisotropicFresnel(Shadowing shadowing, const GgxAlphas<double>& alpha,
                                              const FittedFresnel& fresnel);

// Computed by quadrature, in 6 to 11 ms. shadowing and alpha as for MakeAnisotropicAlbedoFit.
//
// As for MakeDielectricAlbedoFit, eta >= 1. (Below a coat the index may be smaller: light that was
// refracted into the coat is not totally reflected.) The albedo of a curve with total reflection
// follows its corner, smeared by the lobe in both directions, which none of the variables resolves:
// the fit is then off by up to 0.6 where n.v is near the critical cosine, 0.1 in the mean square.
AnisotropicFresnelFit MakeAnisotropicFresnelFit(Shadowing shadowing, const GgxAlphas<double>& alpha,
                                                const CoatedDielectric<double>& dielectric);

// The Fresnel curves of one dielectric along a path of alphas, which follow from a roughness by any
// mapping of brdf/ggx_anisotropic.h with a constant anisotropy. Hits that have a roughness each
// blend theirs from four of these, in a fifth of a microsecond. MakeAnisotropicFresnelCurves takes
// 130 to 220 ms, the more the narrower the streaks are.
using AlphasOfRoughness = std::function<GgxAlphas<double>(double roughness)>;
struct AnisotropicFresnelCurves {
  // By the root of roughness, equidistant on either side of `kink`. There a mapping limits alpha.x,
  // so that the path bends, and cubics across it would be wrong by up to 7e-3.
  std::vector<AnisotropicFresnelCurve> nodes;
  double kink = 1;
  int kink_node = 0;
};

AnisotropicFresnelCurves MakeAnisotropicFresnelCurves(Shadowing shadowing,
                                                      const AlphasOfRoughness& alphas,
                                                      const CoatedDielectric<double>& dielectric);
AnisotropicFresnelCurves MakeAnisotropicFresnelCurves(Shadowing shadowing,
                                                      const AlphasOfRoughness& alphas,
                                                      const FittedFresnel& fresnel);

// The curve of one roughness in [0, 1]. Delta lobes need none: their albedo is the mirror's.
AnisotropicFresnelCurve BlendAnisotropicFresnelCurves(const AnisotropicFresnelCurves& curves,
                                                      double roughness);

}  // namespace nacre
