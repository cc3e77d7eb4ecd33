// SPDX-License-Identifier: Apache-2.0
// color/tone.h: tone operators: linear scene radiance in [0, inf], Rec. 709, to linear display
// light in [0, 1]. SIMD twin: tone-inl.h.
//
// All are finite for every input but NaN. Reinhard and ACES act on each channel by itself;
// Neutral and AgX on the whole colour, desaturating highlights. All are monotone on greys.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <Imath/ImathColor.h>

#include "color/agx.h"

namespace nacre {

enum class ToneOperator : uint8_t { kNeutral, kReinhard, kReinhardExtended, kAces, kAgx, kNone };

// "neutral", "reinhard", "reinhard_extended", "aces", "agx" or "none".
std::string ToneOperatorName(ToneOperator tone);

// All of them, in the order of the enumeration.
std::vector<std::string> ToneOperatorNames();

// Throws Error(kUsage) for an unknown name.
ToneOperator ParseToneOperator(const std::string& name);

// Reinhard et al. 2002, eq. 3: x / (1 + x). The form for x > 1 is equivalent, and avoids inf / inf.
template <typename Real>
Real ToneReinhard(Real x) {
  return x <= 1 ? x / (1 + x) : 1 / (1 + 1 / x);
}

// Reinhard et al. 2002, eq. 4: x (1 + x / white^2) / (1 + x), which reaches 1 at x = white > 0 and
// is cut off there.
template <typename Real>
Real ToneReinhardExtended(Real x, Real white) {
  const Real below = std::min(x, white);
  return std::min(below * (1 + below / (white * white)) / (1 + below), Real(1));
}

// Narkowicz 2015, "ACES Filmic Tone Mapping Curve": a fit, per channel, of the ACES 1.0 reference
// and sRGB output transforms. It is 1 from x = 7.2417 on. Above x = 1, numerator and denominator
// are divided by x^2, which could overflow.
template <typename Real>
Real ToneAces(Real x) {
  const Real u = std::min(x, Real(1));
  const Real v = x > 1 ? 1 / x : Real(1);
  const Real numerator = u * (Real(2.51) * u + Real(0.03) * v);
  const Real denominator = u * (Real(2.43) * u + Real(0.59) * v) + Real(0.14) * v * v;
  return std::min(numerator / denominator, Real(1));
}

// Khronos PBR Neutral Tone Mapper, specification of 2024: below 0.8 - 0.04 it only subtracts the
// Fresnel reflection of 0.04, so that base colours are kept; above it compresses.
template <typename Real>
Imath::Color3<Real> ToneNeutral(Imath::Color3<Real> rgb) {
  constexpr Real kStart = Real(0.8 - 0.04), kDesaturation = Real(0.15), kFresnel90 = Real(0.08);
  constexpr Real kHeadroom = 1 - kStart;
  // The channels are made finite, so that the ratios below are not NaN.
  for (int c = 0; c < 3; ++c) rgb[c] = std::min(rgb[c], std::numeric_limits<Real>::max());
  const Real lowest = std::min({rgb.x, rgb.y, rgb.z});
  // rgb - (lowest - 6.25 lowest^2) where dark; in this order the small difference is exact.
  const Real kept = lowest < kFresnel90 ? Real(6.25) * lowest * lowest : lowest - Real(0.04);
  for (int c = 0; c < 3; ++c) rgb[c] = (rgb[c] - lowest) + kept;
  const Real peak = std::max({rgb.x, rgb.y, rgb.z});
  if (peak < kStart) return rgb;
  const Real new_peak = 1 - kHeadroom * kHeadroom / (peak + (kHeadroom - kStart));
  const Real saturation = 1 / (kDesaturation * (peak - new_peak) + 1);
  // The highest channel becomes new_peak, exactly; the others keep their share of the distance.
  const Real shrink = new_peak * saturation / peak;
  for (int c = 0; c < 3; ++c) rgb[c] = new_peak - shrink * (peak - rgb[c]);
  return rgb;
}

}  // namespace nacre
