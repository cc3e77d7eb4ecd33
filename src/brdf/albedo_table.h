// SPDX-License-Identifier: Apache-2.0
// brdf/albedo_table.h: the table behind MakeAlbedoFit. Its contents are generated at build time, by
// brdf/table/make_albedo_table.cc.
#pragma once

#include <algorithm>
#include <cmath>

#include "brdf/albedo_curve.h"

namespace nacre {

// The table's roughnesses are (i / kAlbedoIntervals)^2: curves change fastest for smooth surfaces.
inline constexpr int kAlbedoIntervals = 40;
inline constexpr int kShadowingForms = 4;

struct AlbedoEntry {
  float one[kAlbedoTerms];
  float schlick[kAlbedoTerms];
  float one_average;  // E_avg of kMasked, otherwise (1 - E_avg) / AverageLossScale
  float schlick_average;
};

extern const AlbedoEntry kAlbedoTable[kShadowingForms][kAlbedoIntervals + 1];

// What 1 - E_avg falls in proportion to: alpha^2 log(1 / alpha) for Smith's forms, alpha for
// kSchlickIbl.
inline double AverageLossScale(AlbedoForm form, double roughness) {
  const double alpha = AlphaFromRoughness(roughness);
  if (form == AlbedoForm::kLossLinear) return alpha;
  return alpha > 0 ? alpha * alpha * (1 + std::log1p(1 / alpha)) : 0;
}

// The roughness at which fits of curves by hit are made for node i. A mirror has no curve: that of
// the next roughness is near the limit for roughness 0.
inline double AlbedoNodeRoughness(int i) {
  const double root = std::max(i, 1) / static_cast<double>(kAlbedoIntervals);
  return root * root;
}

// Cubic interpolation through four consecutive roughnesses of the table around a given one:
// `first` is the index of the first of them.
struct AlbedoWeights {
  int first;
  double weights[4];
};
inline AlbedoWeights FindAlbedoWeights(double roughness) {
  const double position = std::sqrt(roughness) * kAlbedoIntervals;
  const int first = std::clamp(static_cast<int>(position) - 1, 0, kAlbedoIntervals - 3);
  const double t = position - first;
  return {first,
          {(1 - t) * (t - 2) * (t - 3) / 6, t * (t - 2) * (t - 3) / 2, t * (t - 1) * (3 - t) / 2,
           t * (t - 1) * (t - 2) / 6}};
}

}  // namespace nacre
