// SPDX-License-Identifier: Apache-2.0
#include "study/tone_facts.h"

#include <cmath>

#include "color/tone.h"
#include "color/transfer.h"

namespace nacre {

double AcesReachesWhite() {
  double low = 1;
  double high = 100;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (ToneAces(middle) < 1 ? low : high) = middle;
  }
  return high;
}

GammaGap LargestGammaGap() {
  GammaGap gap;
  for (int i = 1; i <= 1000000; ++i) {
    const double linear = i * 1e-6;
    const double difference = std::abs(std::pow(linear, 1 / 2.2) - SrgbOetf(linear));
    if (difference > gap.difference) gap = {difference, linear};
  }
  return gap;
}

}  // namespace nacre
