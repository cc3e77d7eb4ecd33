// SPDX-License-Identifier: Apache-2.0
// study/tone_facts.h: numbers about the tone and transfer curves, computed from the curves
// themselves.
#pragma once

namespace nacre {

// The smallest radiance that ACES (Narkowicz) maps to white.
double AcesReachesWhite();

// The largest difference between x^(1/2.2) and the sRGB curve, and the linear value where it
// occurs.
struct GammaGap {
  double difference = 0, linear = 0;
};
GammaGap LargestGammaGap();

}  // namespace nacre
