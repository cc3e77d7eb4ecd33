// SPDX-License-Identifier: Apache-2.0
#include "study/fresnel_angles.h"

#include <cmath>

#include "brdf/fresnel.h"

namespace nacre {
namespace {

FresnelAngle AngleOf(double cosine) { return {cosine, std::acos(cosine) * 180 / M_PI}; }

}  // namespace

FresnelAngle SchlickAngle(double f0, double reflectance) {
  return AngleOf(1 - std::pow((reflectance - f0) / (1 - f0), 0.2));
}

FresnelAngle DielectricAngle(double eta, double reflectance) {
  double low = 0;
  double high = 1;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (FresnelDielectric(middle, 1 - middle, eta) > reflectance ? low : high) = middle;
  }
  return AngleOf(low);
}

FresnelGap LargestSchlickError(double eta, double k) {
  constexpr int kSteps = 2000;
  const double f0 = FresnelF0(eta, k);
  FresnelGap gap;
  for (int i = 0; i <= kSteps; ++i) {
    const double cosine = static_cast<double>(i) / kSteps;
    const double exact = k > 0 ? FresnelConductor(cosine, 1 - cosine, eta, k)
                               : FresnelDielectric(cosine, 1 - cosine, eta);
    const double difference = std::abs(FresnelSchlick(f0, Power5(1 - cosine)) - exact);
    if (difference > gap.difference) gap = {difference, cosine};
  }
  return gap;
}

}  // namespace nacre
