// SPDX-License-Identifier: Apache-2.0
// brdf/fresnel_table.h: reflectance against the cosine v.h as a table, for curves that are too
// expensive for kernels: thin films, integrated over the spectrum or not. SIMD twin:
// fresnel_table-inl.h.
//
// A table is a cubic spline in a variable that suits Fresnel's equations. They are steepest at
// grazing incidence, where reflectance falls from 1 within a cosine of 1 / |n|, so that the
// variable is the square root of the cosine. Total reflection ends in a square root at the critical
// cosine, which is the variable's origin where there is one. Films of a lower index than the medium
// above have their sharpest fringes about their own critical cosine, equidistant in a square root
// of the distance from it. The spline is of (1 - R) / v.h where that is finite: 1 - R then has a
// small relative error down to grazing incidence.
//
// As many intervals are taken as the tolerance needs: for films up to 2 um 32 to 256 for spectra,
// up to 1024 for lines, and up to 2048 for lines of films of 10 um and for thick films that are
// tunnelled through. Largest errors of 1 - R found, besides that of rounding the cosine to float,
// over 15000 films of random indices: 4e-6 up to 2 um (1.1e-5 for films that are tunnelled
// through), and at 10 um 2e-5 for spectra, 4e-5 for lines. The resonances of a film of 10 um next
// to its own critical cosine are too sharp for 2048 intervals: errors of 1e-3 for spectra and 0.1
// for lines. Making a table takes 0.02 to 0.5 ms, and some ms for films that are tunnelled through.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "base/vec.h"
#include "brdf/thin_film_spectrum.h"

namespace nacre {

// The loss is the spline at `position` times (constant + slope v.h), where
// position = start + scale sqrt(|v.h - corner|), the root with the sign of v.h - corner.
struct FresnelTable {
  float corner = 0;
  float start = 0, scale = 0;
  float constant = 1, slope = 0;
  int intervals = 0;
  // intervals + 3 rows of coefficients of cubic B-splines: the channels, and a 0.
  static constexpr size_t kRow = 4;
  std::vector<float> coefficients;

  bool operator==(const FresnelTable&) const = default;
};

// A curve to be tabulated: 1 - R of each channel at a cosine from 0 to 1.
struct FresnelCurve {
  std::function<Rgb(double cosine)> loss;
  double critical_cosine = 0;  // the loss is 0 below
  double corner = 0;           // the origin of the square root, not below the critical cosine
};

// More intervals are made until the error of 1 - R in the middle of none is above the tolerance.
struct FresnelTableOptions {
  double tolerance = 2e-6;
  int fewest = 32, most = 2048;  // intervals, powers of two
  bool over_cosine = true;  // whether 1 - R may be tabulated over v.h: it is 0 at grazing incidence
};

FresnelTable MakeFresnelTable(const FresnelCurve& curve, const FresnelTableOptions& options = {});

// How a film's reflectance becomes three channels.
enum class ThinFilmModel : uint8_t { kSpectral, kBelcourBarla, kThreeLines };

struct ThinFilmOptions {
  ThinFilmModel model = ThinFilmModel::kSpectral;
  Illuminant illuminant = Illuminant::kEqualEnergy;  // kSpectral
  BelcourBarlaOptions belcour_barla;                 // kBelcourBarla
  std::array<double, 3> lines_nm = kThreeLines;      // kThreeLines
};

// The curve of a film. With a weight below 1, which may be ThinFilmShare's, it is a blend with
// `filmless_loss`, the 1 - R of the interface without film, which need not be Fresnel's but is 0
// below the substrate's critical cosine.
FresnelCurve ThinFilmCurve(const ThinFilm& film, const RgbSubstrate& substrate,
                           const ThinFilmOptions& options = {}, double weight = 1,
                           const std::function<Rgb(double cosine)>& filmless_loss = {});

// The average over the hemisphere, 2 int (1 - R) c dc for each channel, by Gauss-Legendre rules in
// the table's variable on more and more panels until two agree to 1e-7.
Rgb AverageLoss(const FresnelCurve& curve);

// The average of a table: exact for its spline, not clamped.
Rgb AverageLoss(const FresnelTable& table);

// The position in a table and the weights of the four coefficients from there on.
template <typename Real>
struct SplineWeights {
  int first;
  Real weights[4];
};

template <typename Real>
SplineWeights<Real> FindSplineWeights(const FresnelTable& table, Real v_dot_h) {
  const Real distance = v_dot_h - static_cast<Real>(table.corner);
  const Real root = std::copysign(std::sqrt(std::abs(distance)), distance);
  const Real position =
      std::clamp(table.start + table.scale * root, Real(0), static_cast<Real>(table.intervals));
  const int first = std::min(static_cast<int>(position), table.intervals - 1);
  const Real t = position - static_cast<Real>(first);
  const Real u = 1 - t;
  const Real t2 = t * t, u2 = u * u;
  const Real sixth = Real(1) / 6;
  return {first,
          {u2 * u * sixth, (4 + 3 * t2 * (t - 2)) * sixth, (4 + 3 * u2 * (u - 2)) * sixth,
           t2 * t * sixth}};
}

// 1 - R of each channel.
template <typename Real>
std::array<Real, 3> UnclampedLoss(const FresnelTable& table, Real v_dot_h) {
  const SplineWeights<Real> at = FindSplineWeights(table, v_dot_h);
  const Real factor = table.constant + table.slope * v_dot_h;
  const float* rows =
      table.coefficients.data() + FresnelTable::kRow * static_cast<size_t>(at.first);
  std::array<Real, 3> loss{};
  for (size_t i = 0; i < 4; ++i) {
    for (size_t c = 0; c < 3; ++c) {
      loss[c] += at.weights[i] * factor * static_cast<Real>(rows[FresnelTable::kRow * i + c]);
    }
  }
  return loss;
}

// 1 - R of each channel, clamped to [0, 1], which colours of spectra may leave.
template <typename Real>
std::array<Real, 3> FresnelTableLoss(const FresnelTable& table, Real v_dot_h) {
  std::array<Real, 3> loss = UnclampedLoss(table, v_dot_h);
  for (Real& channel : loss) channel = std::clamp(channel, Real(0), Real(1));
  return loss;
}

}  // namespace nacre
