// SPDX-License-Identifier: Apache-2.0
// brdf/sheen.h: the lobe of cloth's fuzz, "Charlie" of Estevez and Kulla 2017, "Production Friendly
// Microfacet Sheen BRDF", as KHR_materials_sheen of glTF 2.0 uses it: distribution,
// masking-shadowing, directional albedo and the scaling of what lies below. There is no Fresnel
// term: a colour multiplies the lobe. SIMD twin: sheen-inl.h.
//
// alpha = roughness^2, as for GGX. The microfacets stand upright, the more so the smaller alpha is:
// light is reflected where light or viewer are within a few times `roughness` (in radians) of the
// horizon. For any directions above the surface the lobe's limit at roughness 0 is 0, so there is
// no sheen where IsDeltaLobe(alpha): it would show only less than 1e-6 rad above the horizon.
#pragma once

#include <algorithm>
#include <cmath>

#include "base/basis.h"
#include "base/vec.h"
#include "brdf/ggx.h"

namespace nacre {

inline constexpr int kCharlieTerms = 8;

// The lobe's constants for one roughness.
template <typename Real>
struct Charlie {
  Real roughness, alpha;
  // log(Lambda(x)) = a / (1 + b x^c) + d x + e for x < 1/2 (Estevez and Kulla 2017), and
  // twice_middle - log(Lambda(1 - x)) for larger x; twice_middle is twice its value at 1/2.
  Real a, b, c, d, e, twice_middle;
  Real typical_lambda;         // half of Lambda at the n.l that most light of the lobe comes from
  Real albedo[kCharlieTerms];  // the polynomial of CharlieAlbedo
};

// Estevez and Kulla 2017: (2 + 1 / alpha) sin^(1 / alpha) / 2 pi of the half vector's angle,
// with sin^2 = 1 / (1 + cos^2 / sin^2), which is right to rounding where sin is next to 1.
template <typename Real>
Real CharlieDistribution(const Angles<Real>& a, Real alpha) {
  if (IsDeltaLobe(alpha) || !(a.n_dot_u > 0)) return 0;
  const Real log_sin2 = -std::log1p(a.n_dot_u * a.n_dot_u / a.nxu_squared);
  return (2 + 1 / alpha) / (2 * static_cast<Real>(M_PI)) * std::exp(log_sin2 / (2 * alpha));
}

// Lambda(x) of a surface whose slopes have a mean grows as 1 / x towards grazing angles. The
// paper's Lambda does so down to about this x and stays finite below it, so that D V n.l, which is
// divided by n.v (1 + Lambda(n.v) + Lambda(n.l)), would grow as 1 / n.v, and reflect any multiple
// of the light. x Lambda(x) is largest at about this x, at every roughness; for smaller x that
// value is used.
inline constexpr double kLeastCharlieCosine = 0x1p-14;

// x Lambda(x), x = n.l or n.v in [0, 1].
template <typename Real>
Real CharlieCosineLambda(const Charlie<Real>& charlie, Real n_dot_x) {
  const Real x = std::max(n_dot_x, static_cast<Real>(kLeastCharlieCosine));
  const bool near = x < Real(0.5);
  const Real y = near ? x : std::max(1 - x, Real(0));
  const Real log_lambda =
      charlie.a / (1 + charlie.b * std::pow(y, charlie.c)) + charlie.d * y + charlie.e;
  return x * std::exp(near ? log_lambda : charlie.twice_middle - log_lambda);
}

// V = G / (4 n.l n.v), G = 1 / (1 + Lambda(n.l) + Lambda(n.v)), from the products
// x Lambda(x): finite unless light and viewer both graze the surface. Requires n.l > 0, n.v >= 0.
// The paper's softer terminator is left out, as in KHR_materials_sheen.
template <typename Real>
Real CharlieVisibility(Real n_dot_l, Real n_dot_v, Real cosine_lambda_l, Real cosine_lambda_v) {
  return 1 / (4 * (n_dot_l * n_dot_v + n_dot_v * cosine_lambda_l + n_dot_l * cosine_lambda_v));
}

// D V, without n.l and without the colour. 0 unless n.l > 0 and n.v >= 0.
template <typename Real>
Real CharlieLobe(const Charlie<Real>& charlie, const Angles<Real>& a) {
  if (!(a.n_dot_l > 0) || !(a.n_dot_v >= 0)) return 0;
  return CharlieDistribution(a, charlie.alpha) *
         CharlieVisibility(a.n_dot_l, a.n_dot_v, CharlieCosineLambda(charlie, a.n_dot_l),
                           CharlieCosineLambda(charlie, a.n_dot_v));
}

// The polynomial of CharlieAlbedo: row i belongs to x^i, x being the variable made of n.v, column j
// to (2 roughness^(1/4) - 1)^j. scripts/fit_sheen.py prints them with their error.
inline constexpr double kCharlieAlbedo[kCharlieTerms][kCharlieTerms] = {
    {0.17253838, 0.104559345, 0.113779475, 0.0273535747, 0.01692275, 0.0366928409, 0.00364515736,
     -0.00500869453},
    {-0.268986066, 0.0675885583, 0.111575788, 0.0800784687, -0.103729576, -0.170655898,
     0.0296120272, 0.078485842},
    {0.0113992265, -0.106428991, 0.0269622935, 0.176718204, -0.0796029007, -0.14837128,
     0.0733312812, 0.0592188894},
    {0.0527531887, -0.0877233477, -0.177426383, -0.127744551, 0.435509157, 0.485704276,
     -0.275106326, -0.318639066},
    {0.0605988667, -0.0622513785, -0.257819164, -0.0221920349, 0.532511967, 0.183406322,
     -0.32049575, -0.14371635},
    {0.0203810818, -0.000255246672, 0.10494989, 0.101734933, -0.533202367, -0.479748832,
     0.403801513, 0.359632938},
    {-0.0370213422, 0.107653501, 0.136167079, -0.289030408, -0.323100876, 0.301677306, 0.203177678,
     -0.087719264},
    {0.00277831598, 0.0550446919, -0.0534765476, -0.231753108, 0.26625326, 0.494006802,
     -0.201344707, -0.292322794},
};

// E: the directional albedo of D V, fitted to its integral within 1.6e-3 for roughnesses from 0.001
// and all n.v, within 2.1e-3 below; the error is relative to E where E is above 1. E is above 1 for
// roughnesses below 0.26 near the horizon: upright microfacets shadow one another more than this
// Lambda models, and at n.v = 0 E grows as 0.18 / roughness. See ScaleSheen.
//
// The half vector that lies nearest the horizon has a sin^2 of (1 + sin(theta_v)) / 2. Its power of
// 1 / (2 alpha), by a series that is smooth at n.v = 1, explains nearly all of the curve's fall.
// The mean of V over the directions of light is V at a typical one times a polynomial in sqrt(u),
// u = n.v (1 + 3 roughness) / (n.v + 3 roughness), which is 1 at n.v = 1 for any roughness.
template <typename Real>
Real CharlieAlbedo(const Charlie<Real>& charlie, Real n_dot_v, Real cosine_lambda_v) {
  if (IsDeltaLobe(charlie.alpha)) return 0;
  const Real mu = std::min(std::max(n_dot_v, Real(0)), Real(1));
  const Real mu2 = mu * mu;
  const Real log_sin2 = std::log1p(-mu2 * (Real(0.25) + mu2 * (Real(0.0625) + mu2 / 8)));
  const Real offset = 3 * charlie.roughness;
  const Real x = 2 * std::sqrt(mu * (1 + offset) / (mu + offset)) - 1;
  Real sum = 0;
  for (int i = kCharlieTerms - 1; i >= 0; --i) sum = sum * x + charlie.albedo[i];
  const Real cosines = mu + cosine_lambda_v + mu * charlie.typical_lambda;
  return std::max(std::exp(log_sin2 / (2 * charlie.alpha)) * sum / (charlie.roughness * cosines),
                  Real(0));
}

template <typename Real>
Real CharlieAlbedo(const Charlie<Real>& charlie, Real n_dot_v) {
  return CharlieAlbedo(charlie, n_dot_v, CharlieCosineLambda(charlie, n_dot_v));
}

// roughness is in [0, 1].
template <typename Real>
Charlie<Real> MakeCharlie(Real roughness) {
  Charlie<Real> charlie;
  charlie.roughness = roughness;
  charlie.alpha = AlphaFromRoughness(roughness);
  // The paper's table has coefficients for alpha 1 and 0, which are mixed by (1 - alpha)^2.
  const Real smooth = (1 - charlie.alpha) * (1 - charlie.alpha);
  const auto mix = [&](double rough_end, double smooth_end) {
    return static_cast<Real>(rough_end) + static_cast<Real>(smooth_end - rough_end) * smooth;
  };
  charlie.a = mix(21.5473, 25.3245);
  charlie.b = mix(3.82987, 3.32435);
  charlie.c = mix(0.19823, 0.16801);
  charlie.d = mix(-1.97760, -1.27393);
  charlie.e = mix(-4.32054, -4.85967);
  const Real half = Real(0.5);
  charlie.twice_middle =
      2 * (charlie.a / (1 + charlie.b * std::pow(half, charlie.c)) + charlie.d * half + charlie.e);
  charlie.typical_lambda = 0;
  std::fill_n(charlie.albedo, kCharlieTerms, Real(0));
  if (IsDeltaLobe(charlie.alpha)) return charlie;
  const Real typical = roughness / (1 + roughness);
  charlie.typical_lambda = CharlieCosineLambda(charlie, typical) / (2 * typical);
  const Real y = 2 * std::sqrt(std::sqrt(roughness)) - 1;
  for (int i = 0; i < kCharlieTerms; ++i) {
    Real sum = 0;
    for (int j = kCharlieTerms - 1; j >= 0; --j) {
      sum = sum * y + static_cast<Real>(kCharlieAlbedo[i][j]);
    }
    charlie.albedo[i] = sum;
  }
  return charlie;
}

// The factors by which a layer of sheen and what lies below it share the light.
template <typename Real>
struct SheenScale {
  Real lobe;   // multiplies colour D V
  Real below;  // multiplies the BRDF below
};

// KHR_materials_sheen: what lies below is scaled by min(1 - m E(n.v), 1 - m E(n.l)), m being the
// largest channel of the sheen's colour. This is reciprocal, and a white surface reflects no more
// light than it receives: the lobe m E(n.v), and what is below at most 1 - m E(n.v). The extension
// does not say what happens where m E exceeds 1 in either direction; here the BRDF below is scaled
// by 0, and the lobe is divided by the larger m E, so that it reflects at most all light and stays
// reciprocal. With E(n.v) for both albedos (SheenScaling::kConserving) a white surface reflects
// exactly all light.
template <typename Real>
SheenScale<Real> ScaleSheen(Real largest_channel, Real albedo_v, Real albedo_l) {
  const Real share = largest_channel * std::max(albedo_v, albedo_l);
  return {share > 1 ? 1 / share : Real(1), share < 1 ? 1 - share : Real(0)};
}

// Samples directions to light for the lobe: the azimuth is uniform, and n.l has the pdf
// 2 w (1 + w)^2 n.l / (n.l + w)^3, w = roughness, which like D V n.l peaks at n.l = w / 2 and falls
// off above. The square root of u0 is (1 + w) n.l / (n.l + w), so all directions are above the
// surface. Sampled half vectors of the lobe would lie near the horizon, and mirror v to below the
// surface more often than not; cosine-weighted directions miss the horizon. The table gives the
// standard deviation of one sample, D V n.l over the pdf, relative to its mean, by quadrature, at
// n.v = 0.1 and 0.6:
//
//   roughness   this sampler   cosine-weighted   uniform      half vectors of D
//   0.1         1.1    2.3     5.7    14         2.1    4.3   1.0    37
//   0.3         0.68   1.1     1.9    2.2        0.90   1.3   0.79   2.0
//   0.5         0.47   0.73    1.2    1.1        0.55   0.81  0.82   1.4
//   1           0.23   0.36    0.71   0.50       0.30   0.48  0.90   1.1
template <typename Real>
Imath::Vec3<Real> SampleCharlie(const Imath::Vec3<Real>& normal, Real roughness, Real u0, Real u1) {
  const Real root = std::sqrt(u0);
  const Real one_minus_root = (1 - u0) / (1 + root);  // without cancellation, for n.l near 1
  const Real n_dot_l = roughness * root / (roughness + one_minus_root);
  const Real sin = std::sqrt((1 - n_dot_l) * (1 + n_dot_l));
  const Real phi = 2 * static_cast<Real>(M_PI) * u1;
  return BasisAbout(normal).ToWorld({sin * std::cos(phi), sin * std::sin(phi), n_dot_l});
}

// The pdf per solid angle, which integrates to 1 over the hemisphere. It is 0 for a roughness of 0,
// which has no lobe.
template <typename Real>
Real CharliePdf(Real n_dot_l, Real roughness) {
  if (!(n_dot_l > 0)) return 0;
  const Real inverse = 1 / (n_dot_l + roughness);
  const Real squared = (1 + roughness) * (1 + roughness);
  return roughness * inverse * squared * (n_dot_l * inverse) * inverse / static_cast<Real>(M_PI);
}

}  // namespace nacre
