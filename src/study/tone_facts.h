// SPDX-License-Identifier: Apache-2.0
// study/tone_facts.h: numbers of the tone and transfer curves, found on the curves themselves.
#pragma once

namespace nacre {

// The radiance from which on ACES (Narkowicz) is white.
double AcesReachesWhite();

// The largest difference between x^(1/2.2) and the sRGB curve, and the linear value where it is.
struct GammaGap {
  double difference = 0, linear = 0;
};
GammaGap LargestGammaGap();

}  // namespace nacre
