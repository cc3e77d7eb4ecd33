// SPDX-License-Identifier: Apache-2.0
#include "brdf/albedo_curve.h"

#include "brdf/chebyshev.h"

namespace nacre {
AlbedoShape MakeAlbedoShape(Shadowing shadowing, double roughness) {
  AlbedoShape shape;
  double alpha = AlphaFromRoughness(roughness);
  if (IsDeltaLobe(alpha)) alpha = 0;
  const double offset = double{kAlbedoOffsetOverAlpha} * alpha;
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
  const double root =
      (1 + ChebyshevNode(static_cast<size_t>(i), kAlbedoTerms)) / double{shape.scale};
  const double tangent = root * root;  // tan(theta / 2)
  return std::min(1.0, 2 * double{shape.offset} * tangent / ((1 - tangent) * (1 + tangent)));
}

std::array<double, kAlbedoTerms> InterpolateAlbedo(const std::array<double, kAlbedoTerms>& values) {
  return InterpolateChebyshev(values);
}

}  // namespace nacre
