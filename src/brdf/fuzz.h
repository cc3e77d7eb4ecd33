// SPDX-License-Identifier: Apache-2.0
// brdf/fuzz.h: the lobe of fuzz as OpenPBR uses it: Zeltner, Burley and Chiang 2022, "Practical
// Multiple-Scattering Sheen Using Linearly Transformed Cosines", the variant "volume": what a layer
// of fibres that stand upright on the surface reflects, of light of all orders of scattering. There
// is no Fresnel term: a colour multiplies the lobe. SIMD twin: fuzz-inl.h.
//
// The light reflected to the viewer, BRDF times n.l, is R(n.v) D(l). D is the pdf of a
// cosine-weighted direction that the matrix M transforms (Heitz et al. 2016): with w = M^-1 l,
//
//   M^-1 = [[a, 0, b], [0, a, 0], [0, 0, 1]],   D = max(w_z, 0) / (pi |w|) a^2 / |w|^3,
//
// in the frame whose x axis is the azimuth of the viewer. Because w_z is n.l, all of D is above the
// surface, where it integrates to 1: R is exactly the directional albedo of the lobe, and what is
// below the fuzz is scaled by 1 - R. The lobe is not reciprocal.
//
// R, a and b depend on roughness and n.v. They are fitted by scripts/fit_fuzz.py to a solution of
// the paper's layer. Its differences from the table that the paper's authors publish, where that
// has an R above 0.01, and those of the fit below, rms and worst:
//
//                               R                  a                 b
//   roughness 0.2 to 1, layer   0.0006   0.0036    0.0031   0.018    0.0007   0.011
//   roughness 0.2 to 1, fit     0.0024   0.0049    0.0055   0.021    0.0027   0.011
//   all roughnesses, layer      0.012    0.24      0.0061   0.040    0.0015   0.023
//   all roughnesses, fit        0.012    0.24      0.0076   0.041    0.0034   0.025
//
// R differs so much only for a roughness below 0.2 at an n.v below 0.1: light that grazes smooth
// fibres is scattered more often than the 16 times at which the authors' simulation ends. The fit's
// R is that of the layer within 0.006 for a roughness of 0.06 and more, and within 0.013 below. The
// transformed cosine has only roughly the shape of what the layer reflects, here as in the paper:
// their absolute difference integrates to up to 0.2 R at roughness 1, and 0.35 R at 0.3.
#pragma once

#include <algorithm>
#include <cmath>

#include "base/basis.h"
#include "base/vec.h"
#include "brdf/angles.h"
#include "brdf/fuzz_fit.h"

namespace nacre {

// A smaller roughness counts as this, as in the paper: such fuzz would show only where the surface
// is seen at an angle of less than 0.01 rad.
inline constexpr double kLeastFuzzRoughness = 0.01;

// The lobe's constants for one roughness: polynomials in a function of n.v, lowest power first.
template <typename Real>
struct Fuzz {
  Real roughness;
  Real offset;  // n.v of about this is in the middle of that function's range
  Real log_albedo[kFuzzTerms];
  Real log_a[kFuzzTerms];
  Real tilt[kFuzzTerms];
};

// roughness is in [0, 1].
template <typename Real>
Fuzz<Real> MakeFuzz(Real roughness) {
  Fuzz<Real> fuzz;
  fuzz.roughness = std::max(roughness, static_cast<Real>(kLeastFuzzRoughness));
  const Real fourth_root = std::sqrt(std::sqrt(fuzz.roughness));
  fuzz.offset = 2 * fuzz.roughness * fourth_root;
  const Real least = std::sqrt(std::sqrt(static_cast<Real>(kLeastFuzzRoughness)));
  const Real y = 2 * (fourth_root - least) / (1 - least) - 1;
  const auto in_x = [&](const FuzzTable& table, Real factor, Real* polynomial) {
    for (int i = 0; i < kFuzzTerms; ++i) {
      Real sum = 0;
      for (int j = kFuzzTerms - 1; j >= 0; --j) {
        sum = sum * y + static_cast<Real>(table.terms[i][j]);
      }
      polynomial[i] = factor * sum;
    }
  };
  in_x(kFuzzLogAlbedo, Real(1), fuzz.log_albedo);
  in_x(kFuzzLogA, Real(1), fuzz.log_a);
  // Fibres as wide as they are long scatter light evenly about the normal.
  in_x(kFuzzTilt, 1 - fuzz.roughness, fuzz.tilt);
  return fuzz;
}

// The lobe as one viewer sees it.
template <typename Real>
struct FuzzView {
  Real albedo;  // R, in [0, 1]
  Real a;       // above 0
  Real tilt;    // b / sin(theta_v), which has a limit along the normal, where b is 0
};

// An n.v below 0 counts as 0, the limit for grazing viewers.
template <typename Real>
FuzzView<Real> FuzzFromView(const Fuzz<Real>& fuzz, Real n_dot_v) {
  const Real mu = std::min(std::max(n_dot_v, Real(0)), Real(1));
  const Real ratio = mu * (1 + fuzz.offset) / (mu + fuzz.offset);
  const Real x = 2 * std::sqrt(std::sqrt(ratio)) - 1;
  Real log_albedo = 0, log_a = 0, tilt = 0;
  for (int i = kFuzzTerms - 1; i >= 0; --i) {
    log_albedo = log_albedo * x + fuzz.log_albedo[i];
    log_a = log_a * x + fuzz.log_a[i];
    tilt = tilt * x + fuzz.tilt[i];
  }
  return {std::min(std::exp(log_albedo), Real(1)), std::exp(log_a), tilt};
}

template <typename Real>
Real FuzzAlbedo(const Fuzz<Real>& fuzz, Real n_dot_v) {
  return FuzzFromView(fuzz, n_dot_v).albedo;
}

// (a / |w|^2)^2 / pi, which is D / n.l: |w|^2 is
//
//   (a l_x + b l_z)^2 + (a l_y)^2 + l_z^2 = a^2 sin^2 + 2 a b l_x l_z + (1 + b^2) l_z^2.
//
// With b = tilt sin(theta_v), b l_x is the tilt times the product of what of l and v is across the
// normal, l.v - n.l n.v, so that no azimuth is needed, which v = n does not have. |tilt| is below
// 0.2, so that the sum is at least 0.8 times a^2 sin^2 + l_z^2, and nothing cancels.
template <typename Real>
Real FuzzDistribution(const FuzzView<Real>& view, const Angles<Real>& a) {
  const Real across = LightDotView(a) - a.n_dot_l * a.n_dot_v;
  const Real sin2_l = (1 - a.n_dot_l) * (1 + a.n_dot_l);
  const Real sin2_v = (1 - a.n_dot_v) * (1 + a.n_dot_v);
  const Real length2 = view.a * (view.a * sin2_l + 2 * view.tilt * across * a.n_dot_l) +
                       (1 + view.tilt * view.tilt * sin2_v) * a.n_dot_l * a.n_dot_l;
  const Real ratio = view.a / length2;
  return ratio * ratio / static_cast<Real>(M_PI);
}

// The BRDF, without the colour. 0 unless n.l > 0; at grazing light it has a limit.
template <typename Real>
Real FuzzLobe(const FuzzView<Real>& view, const Angles<Real>& a) {
  if (!(a.n_dot_l > 0)) return 0;
  return view.albedo * FuzzDistribution(view, a);
}

// Samples D exactly: a cosine-weighted direction times M. Its x and y components are those of any
// axes across the normal, as its azimuth is uniform, and M moves it along what of v is across the
// normal. u0 and u1 are in [0, 1); all directions are above the surface.
template <typename Real>
Imath::Vec3<Real> SampleFuzz(const Imath::Vec3<Real>& normal, const Imath::Vec3<Real>& to_view,
                             const FuzzView<Real>& view, Real u0, Real u1) {
  const Real radius = std::sqrt(u0), cos = std::sqrt(1 - u0);
  const Real phi = 2 * static_cast<Real>(M_PI) * u1;
  const Imath::Vec3<Real> across = to_view - normal * (normal ^ to_view);
  const Imath::Vec3<Real> l =
      BasisAbout(normal).ToWorld({radius * std::cos(phi), radius * std::sin(phi), view.a * cos});
  return (l - across * (view.tilt * cos)).normalized();
}

// D, the pdf per solid angle, which integrates to 1 over the hemisphere.
template <typename Real>
Real FuzzPdf(const FuzzView<Real>& view, const Angles<Real>& a) {
  return a.n_dot_l > 0 ? a.n_dot_l * FuzzDistribution(view, a) : Real(0);
}

}  // namespace nacre
