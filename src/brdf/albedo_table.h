// brdf/albedo_table.h: the table behind MakeAlbedoFit. Its contents are generated at build time, by
// brdf/table/make_albedo_table.cc.
#pragma once

#include <cmath>

#include "brdf/albedo_curve.h"

namespace nacre {

// Roughnesses stand at (i / kAlbedoIntervals)^2: curves change fastest where surfaces are smooth.
inline constexpr int kAlbedoIntervals = 40;
inline constexpr int kShadowingForms = 3;

struct AlbedoEntry {
  float one[kAlbedoTerms];
  float schlick[kAlbedoTerms];
  float one_average;  // (1 - E_avg) / AverageLossScale of Smith's forms, E_avg of kSchlickDirect
  float schlick_average;
};

extern const AlbedoEntry kAlbedoTable[kShadowingForms][kAlbedoIntervals + 1];

// 1 - E_avg falls as alpha^2 log(1 / alpha).
inline double AverageLossScale(double alpha) {
  return alpha > 0 ? alpha * alpha * (1 + std::log1p(1 / alpha)) : 0;
}

}  // namespace nacre
