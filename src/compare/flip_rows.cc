// SPDX-License-Identifier: Apache-2.0
#include "compare/flip_rows.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/aligned.h"

namespace nacre {
namespace {

constexpr double kPi = std::numbers::pi;

// Spatial contrast sensitivity with the constants of table 1: sums of a sqrt(pi / b) exp(-pi^2 z^2
// / b) at z degrees. Luminance and red-green have one term, blue-yellow has two.
struct SensitivityTerm {
  double a, b;
};
constexpr SensitivityTerm kLuminanceTerm = {1, 0.0047}, kRedGreenTerm = {1, 0.0053};
constexpr SensitivityTerm kBlueYellowTerms[] = {{34.1, 0.04}, {13.5, 0.025}};
constexpr double kWidestB = 0.04;

// The width of perceived features, in degrees.
constexpr double kFeatureWidth = 0.082;

// The standard deviation in pixels of exp(-pi^2 z^2 / b), a Gaussian with sigma^2 = b / (2 pi^2).
double SensitivitySigma(double b, double pixels_per_degree) {
  return std::sqrt(b / (2 * kPi * kPi)) * pixels_per_degree;
}

// The share of the first term in the blue-yellow filter, which is normalised to a sum of 1 over the
// square window.
double ShareOfFirst(double pixels_per_degree, int radius) {
  const auto volume = [&](const SensitivityTerm& term) {
    double sum = 0;
    for (int x = -radius; x <= radius; ++x) {
      const double z = x / pixels_per_degree;
      sum += std::exp(-kPi * kPi * z * z / term.b);
    }
    return term.a * std::sqrt(kPi / term.b) * sum * sum;
  };
  const double first = volume(kBlueYellowTerms[0]);
  return first / (first + volume(kBlueYellowTerms[1]));
}

int ThreeSigmas(double sigma) { return static_cast<int>(std::ceil(3 * sigma)); }

// Scales positive weights to a sum of 1, and negative ones to -1.
void Balance(Kernel* kernel) {
  double positive = 0, negative = 0;
  for (const double weight : *kernel) (weight > 0 ? positive : negative) += std::abs(weight);
  for (double& weight : *kernel) weight /= weight > 0 ? positive : negative;
}

}  // namespace

FlipFilters MakeFlipFilters(double pixels_per_degree) {
  FlipFilters filters;
  // The radius of all is three sigmas of the widest.
  const int radius = ThreeSigmas(SensitivitySigma(kWidestB, pixels_per_degree));
  const auto sensitivity = [&](const SensitivityTerm& term) {
    return GaussianKernel(SensitivitySigma(term.b, pixels_per_degree), radius);
  };
  filters.luminance = sensitivity(kLuminanceTerm);
  filters.red_green = sensitivity(kRedGreenTerm);
  filters.blue_yellow[0] = sensitivity(kBlueYellowTerms[0]);
  filters.blue_yellow[1] = sensitivity(kBlueYellowTerms[1]);
  filters.first_share = ShareOfFirst(pixels_per_degree, radius);

  const double sigma = 0.5 * kFeatureWidth * pixels_per_degree;
  const int feature_radius = ThreeSigmas(sigma);
  filters.smooth = GaussianKernel(sigma, feature_radius);
  filters.edge = filters.point = filters.smooth;
  for (int x = -feature_radius; x <= feature_radius; ++x) {
    const auto i = static_cast<size_t>(x + feature_radius);
    filters.edge[i] *= -x;
    filters.point[i] *= x * x / (sigma * sigma) - 1;
  }
  Balance(&filters.edge);
  Balance(&filters.point);
  return filters;
}

int RadiusOf(const FlipFilters& filters) {
  return static_cast<int>(std::max(filters.luminance.size(), filters.smooth.size()) / 2);
}

namespace {

FlipFilter ToFloat(const Kernel& kernel, double scale_down = 1) {
  const size_t centre = kernel.size() / 2;
  size_t radius = centre;
  for (double left_out = 0; radius > 0; --radius) {
    left_out += 2 * std::abs(kernel[centre + radius]);
    if (left_out > 0x1p-25) break;
  }
  FlipFilter filter;
  filter.full.assign(kFlipBlockRows - 1, 0.0f);
  for (size_t i = centre - radius; i <= centre + radius; ++i) {
    filter.full.push_back(static_cast<float>(scale_down * kernel[i]));
    if (i >= centre) filter.half.push_back(static_cast<float>(kernel[i]));
  }
  filter.full.resize(filter.full.size() + kFlipBlockRows - 1);
  return filter;
}

}  // namespace

FlipWeights MakeFlipWeights(double pixels_per_degree) {
  const FlipFilters filters = MakeFlipFilters(pixels_per_degree);
  FlipWeights weights;
  weights.luminance = ToFloat(filters.luminance);
  weights.red_green = ToFloat(filters.red_green);
  weights.blue_yellow[0] = ToFloat(filters.blue_yellow[0], filters.first_share);
  weights.blue_yellow[1] = ToFloat(filters.blue_yellow[1], 1 - filters.first_share);
  weights.smooth = ToFloat(filters.smooth);
  weights.edge = ToFloat(filters.edge);
  weights.point = ToFloat(filters.point);
  weights.radius = static_cast<size_t>(RadiusOf(filters));
  return weights;
}

size_t FlipLineRoom(size_t radius) { return RoundUp(kFlipColumns + 2 * radius, kBatchPadding); }

}  // namespace nacre
