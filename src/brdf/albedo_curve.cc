// SPDX-License-Identifier: Apache-2.0
#include "brdf/albedo_curve.h"

namespace nacre {
namespace {

double NodeAngle(int i) { return M_PI * (i + 0.5) / kAlbedoTerms; }

}  // namespace

AlbedoShape MakeAlbedoShape(Shadowing shadowing, double roughness) {
  AlbedoShape shape;
  double alpha = AlphaFromRoughness(roughness);
  if (IsDeltaLobe(alpha)) alpha = 0;
  const double offset = 6 * alpha;
  shape.offset = static_cast<float>(offset);
  shape.scale = static_cast<float>(2 * std::sqrt(offset + std::sqrt(1 + offset * offset)));
  shape.form = AlbedoFormOf(shadowing);
  if (shape.form == AlbedoForm::kMasked) {
    const double k = SchlickK(shadowing, roughness);
    shape.k = static_cast<float>(k);
    // The albedo that is left at n.v = 0 is a moment of D's tail, alpha^2 log(1 / alpha), cut off
    // at k.
    if (alpha > 0) {
      shape.softening = static_cast<float>(alpha * alpha * (2 + std::log(1 + k / alpha)));
    }
  }
  return shape;
}

double AlbedoNodeCosine(const AlbedoShape& shape, int i) {
  const double root = (1 + std::cos(NodeAngle(i))) / double{shape.scale};
  const double tangent = root * root;  // tan(theta / 2)
  return std::min(1.0, 2 * double{shape.offset} * tangent / ((1 - tangent) * (1 + tangent)));
}

std::array<double, kAlbedoTerms> InterpolateAlbedo(const std::array<double, kAlbedoTerms>& values) {
  std::array<double, kAlbedoTerms> polynomial{};
  // `chebyshev` holds the coefficients of T_j, from the recurrence T_j+1 = 2 z T_j - T_j-1.
  std::array<double, kAlbedoTerms> before{};
  std::array<double, kAlbedoTerms> chebyshev{1};
  for (size_t j = 0; j < kAlbedoTerms; ++j) {
    double weight = 0;
    for (size_t i = 0; i < kAlbedoTerms; ++i) {
      weight += values[i] * std::cos(static_cast<double>(j) * NodeAngle(static_cast<int>(i)));
    }
    weight *= (j == 0 ? 1.0 : 2.0) / kAlbedoTerms;
    std::array<double, kAlbedoTerms> next{};
    for (size_t i = 0; i < kAlbedoTerms; ++i) {
      polynomial[i] += weight * chebyshev[i];
      next[i] = (i == 0 ? 0 : (j == 0 ? 1.0 : 2.0) * chebyshev[i - 1]) - before[i];
    }
    before = chebyshev;
    chebyshev = next;
  }
  return polynomial;
}

}  // namespace nacre
