// SPDX-License-Identifier: Apache-2.0
// brdf/anisotropic_albedo_table.h: the table behind MakeAnisotropicAlbedoFit. Its contents are
// generated at build time, by brdf/table/make_anisotropic_albedo_table.cc.
#pragma once

#include <algorithm>
#include <cmath>

#include "brdf/anisotropic_albedo_curve.h"

namespace nacre {

// Smith's two forms, in the order of Shadowing. The alphas along the tangent are
// kLargestAlbedoAlpha (i / kAlphaIntervals)^4, and the ratios ay / ax are (j / kRatioIntervals)^3:
// albedos change fastest for smooth surfaces and for streaks.
inline constexpr int kSmithForms = 2;
inline constexpr int kAlphaIntervals = 20;
inline constexpr int kRatioIntervals = 16;

struct AnisotropicAlbedoEntry {
  SharePolynomial loss, schlick;
  float loss_average;  // over AnisotropicLossScale
  float schlick_average;
};

extern const AnisotropicAlbedoEntry kAnisotropicAlbedoTable[kSmithForms][kAlphaIntervals + 1]
                                                           [kRatioIntervals + 1];
// The part of the albedo for Schlick's weight that the limit ay = 0 has, too.
extern const WidthPolynomial kStreakAlbedoTable[kSmithForms][kAlphaIntervals + 1];

// What the mean loss falls in proportion to.
inline double AnisotropicLossScale(const GgxAlphas<double>& alpha) {
  const double mean_square = (alpha.x * alpha.x + alpha.y * alpha.y) / 2;
  return mean_square > 0 ? mean_square * (1 + std::log1p(1 / std::sqrt(mean_square))) : 0;
}

// Cubic interpolation through four consecutive entries around `position`: `first` is the index of
// the first of them.
struct CubicWeights {
  int first;
  double weights[4];
};
inline CubicWeights FindCubicWeights(double position, int intervals) {
  const int first = std::clamp(static_cast<int>(position) - 1, 0, intervals - 3);
  const double t = position - first;
  return {first,
          {(1 - t) * (t - 2) * (t - 3) / 6, t * (t - 2) * (t - 3) / 2, t * (t - 1) * (3 - t) / 2,
           t * (t - 1) * (t - 2) / 6}};
}
inline CubicWeights FindAlphaWeights(double alpha_x) {
  const double root = std::sqrt(std::sqrt(alpha_x / kLargestAlbedoAlpha));
  return FindCubicWeights(root * kAlphaIntervals, kAlphaIntervals);
}
inline CubicWeights FindRatioWeights(double ratio) {
  return FindCubicWeights(std::cbrt(ratio) * kRatioIntervals, kRatioIntervals);
}

}  // namespace nacre
