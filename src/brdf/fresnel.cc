// SPDX-License-Identifier: Apache-2.0
#include "brdf/fresnel.h"

#include <algorithm>
#include <cmath>

#include "brdf/quadrature.h"

namespace nacre {

double AverageDielectric(double eta) {
  if (eta >= 1) {
    return IntegrateTowardsZero([&](double c) { return 2 * c * FresnelDielectric(c, 1 - c, eta); });
  }
  // Reflection is total up to the critical cosine. From there on, the variable of integration is g,
  // g^2 = eta^2 - sin^2, g dg = c dc, in which the curve has no square root left.
  const double critical2 = (1 - eta) * (1 + eta);
  return critical2 + eta * IntegrateTowardsZero([&](double x) {
                       const double g = x * eta;
                       const double c = std::min(1.0, std::sqrt(critical2 + g * g));
                       return 2 * g * FresnelDielectric(c, 1 - c, eta);
                     });
}

double AverageDielectric(const CoatedDielectric<double>& base) {
  const double in_air = AverageDielectric(base.eta);
  if (!(base.coat > 0)) return in_air;
  CoatedDielectric<double> covered = base;
  covered.coat = 1;
  const double in_coat = IntegrateTowardsZero(
      [&](double c) { return 2 * c * FresnelCoatedDielectric(c, 1 - c, covered); });
  return in_air + base.coat * (in_coat - in_air);
}

double AverageConductor(double eta, double k) {
  return IntegrateTowardsZero([&](double c) { return 2 * c * FresnelConductor(c, 1 - c, eta, k); });
}

}  // namespace nacre
