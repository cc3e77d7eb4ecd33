// SPDX-License-Identifier: Apache-2.0
#include "brdf/anisotropic_albedo.h"

#include <algorithm>

#include "brdf/anisotropic_albedo_table.h"

namespace nacre {
namespace {

// to += weight * polynomial.
template <size_t kTerms>
void AddPolynomial(float weight, const std::array<KappaPolynomial, kTerms>& polynomial,
                   std::array<KappaPolynomial, kTerms>* to) {
  for (size_t i = 0; i < kTerms; ++i) {
    for (size_t k = 0; k < kKappaTerms; ++k) (*to)[i][k] += weight * polynomial[i][k];
  }
}

}  // namespace

AnisotropicAlbedoFit MakeAnisotropicAlbedoFit(Shadowing shadowing, const GgxAlphas<double>& alpha) {
  AnisotropicAlbedoFit fit;
  if (IsDeltaLobe(alpha)) return fit;
  const double shrink = std::min(kLargestAlbedoAlpha / alpha.x, 1.0);
  const GgxAlphas<double> shrunk{alpha.x * shrink, alpha.y * shrink};
  fit.shape = MakeAnisotropicAlbedoShape(shrunk);
  const auto form = static_cast<size_t>(shadowing);
  const CubicWeights x = FindAlphaWeights(shrunk.x);
  const CubicWeights ratio = FindRatioWeights(std::min(shrunk.y / shrunk.x, 1.0));
  double loss_average = 0, schlick_average = 0;
  for (int i = 0; i < 4; ++i) {
    AddPolynomial(static_cast<float>(x.weights[i]), kStreakAlbedoTable[form][x.first + i],
                  &fit.streak);
    for (int j = 0; j < 4; ++j) {
      const AnisotropicAlbedoEntry& entry =
          kAnisotropicAlbedoTable[form][x.first + i][ratio.first + j];
      const double weight = x.weights[i] * ratio.weights[j];
      AddPolynomial(static_cast<float>(weight), entry.loss, &fit.loss);
      AddPolynomial(static_cast<float>(weight), entry.schlick, &fit.schlick);
      loss_average += weight * double{entry.loss_average};
      schlick_average += weight * double{entry.schlick_average};
    }
  }
  fit.e_average = 1 - loss_average * AnisotropicLossScale(shrunk);
  fit.schlick_average = schlick_average;
  return fit;
}

}  // namespace nacre
