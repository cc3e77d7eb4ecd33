// SPDX-License-Identifier: Apache-2.0
#include "sampling/pixel_filter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace nacre {
namespace {

using std::numbers::pi;

constexpr double kGaussianCutoff = 3;  // in standard deviations
constexpr double kBlackmanHarris[4] = {0.35875, 0.48829, 0.14128, 0.01168};
constexpr double kMitchellZero = 8.0 / 7;  // where the filter becomes negative, at width 4

double GaussianNormalization() { return std::erf(kGaussianCutoff / std::numbers::sqrt2); }

// Mitchell and Netravali 1988, eq. 8, with B = C = 1/3, times 6; t in [0, 2].
double MitchellTimes6(double t) {
  return t < 1 ? (7 * t - 12) * t * t + 16.0 / 3 : ((-7.0 / 3 * t + 12) * t - 20) * t + 32.0 / 3;
}

// The integral of MitchellTimes6 from 0 to t.
double MitchellIntegralTimes6(double t) {
  const auto inner = [](double s) { return ((7.0 / 4 * s - 4) * s * s + 16.0 / 3) * s; };
  const auto outer = [](double s) { return (((-7.0 / 12 * s + 4) * s - 10) * s + 32.0 / 3) * s; };
  return t < 1 ? inner(t) : inner(1) + (outer(t) - outer(1));
}

// The quantiles of the part of f between the distances `first`, at t = 0, and `last`, at t = 1.
QuantileTable MakeQuantiles(const PixelFilter& filter, double first, double last) {
  const double mass_before = FilterIntegral(filter, first);
  const double mass = FilterIntegral(filter, last) - mass_before;  // negative in a negative lobe
  QuantileTable quantiles = {first};
  for (int i = 1; i < kQuantileSteps; ++i) {
    const double root = 1 - static_cast<double>(i) / kQuantileSteps;
    const double share = 1 - root * root;
    double low = quantiles.back();
    double high = last;
    while (high - low > 1e-12 * filter.width) {
      const double middle = (low + high) / 2;
      const bool below = (FilterIntegral(filter, middle) - mass_before) / mass < share;
      (below ? low : high) = middle;
    }
    quantiles.push_back((low + high) / 2);
  }
  quantiles.push_back(last);
  return quantiles;
}

// Maps u in [0, 1) to a signed distance from the centre: to the left of it for u < 1/2, to the
// right of it otherwise.
double SampleDistance(const QuantileTable& quantiles, double u) {
  const double outside = 1 - std::abs(2 * u - 1);  // the fraction of the mass that is further out
  const double position = (1 - std::sqrt(outside)) * kQuantileSteps;
  const auto i = static_cast<size_t>(std::min(position, kQuantileSteps - 1.0));
  const double fraction = position - static_cast<double>(i);
  const double distance = quantiles[i] + fraction * (quantiles[i + 1] - quantiles[i]);
  return u < 0.5 ? -distance : distance;
}

}  // namespace

double FilterValue(const PixelFilter& filter, double x) {
  const double distance = std::abs(x);
  const double width = filter.width;
  if (distance > width / 2) return 0;
  switch (filter.kind) {
    case FilterKind::kBox:
      return 1 / width;
    case FilterKind::kGaussian: {
      const double sigma = width / (2 * kGaussianCutoff);
      return std::exp(-0.5 * (x / sigma) * (x / sigma)) /
             (sigma * std::sqrt(2 * pi) * GaussianNormalization());
    }
    case FilterKind::kBlackmanHarris: {
      double sum = kBlackmanHarris[0];
      for (int k = 1; k < 4; ++k) sum += kBlackmanHarris[k] * std::cos(2 * pi * k * x / width);
      return sum / (kBlackmanHarris[0] * width);
    }
    case FilterKind::kMitchell:
      return MitchellTimes6(4 * distance / width) / 6 * (4 / width);
  }
  return 0;
}

double FilterIntegral(const PixelFilter& filter, double x) {
  const double width = filter.width;
  switch (filter.kind) {
    case FilterKind::kBox:
      return x / width;
    case FilterKind::kGaussian:
      return 0.5 * std::erf(x * 2 * kGaussianCutoff / (width * std::numbers::sqrt2)) /
             GaussianNormalization();
    case FilterKind::kBlackmanHarris: {
      double sum = kBlackmanHarris[0] * x / width;
      for (int k = 1; k < 4; ++k) {
        sum += kBlackmanHarris[k] * std::sin(2 * pi * k * x / width) / (2 * pi * k);
      }
      return sum / kBlackmanHarris[0];
    }
    case FilterKind::kMitchell:
      return MitchellIntegralTimes6(4 * x / width) / 6;
  }
  return 0;
}

FilterSampler MakeFilterSampler(const PixelFilter& filter) {
  FilterSampler sampler;
  sampler.filter = filter;
  if (filter.kind == FilterKind::kBox) return sampler;
  if (filter.kind != FilterKind::kMitchell) {
    sampler.positive = MakeQuantiles(filter, 0, filter.width / 2);
    return sampler;
  }
  const double zero = kMitchellZero * filter.width / 4;
  sampler.positive_mass = 2 * FilterIntegral(filter, zero);
  sampler.negative_mass = sampler.positive_mass - 1;
  sampler.positive = MakeQuantiles(filter, 0, zero);
  sampler.negative = MakeQuantiles(filter, zero, filter.width / 2);
  return sampler;
}

double PartMass(const FilterSampler& sampler, FilterPart part) {
  const double p = sampler.positive_mass;
  const double n = sampler.negative_mass;
  return part == FilterPart::kPositive ? p * p + n * n : 2 * p * n;
}

double FirstRegionShare(const FilterSampler& sampler, FilterPart part) {
  if (part == FilterPart::kNegative) return 0.5;
  return sampler.positive_mass * sampler.positive_mass / PartMass(sampler, part);
}

Vec2d SampleFilter(const FilterSampler& sampler, FilterPart part, const Vec2d& u) {
  if (sampler.positive.empty()) return (u - Vec2d(0.5)) * sampler.filter.width;
  if (sampler.negative.empty()) {
    return {SampleDistance(sampler.positive, u.x), SampleDistance(sampler.positive, u.y)};
  }
  // u.x chooses the region, and is remapped to [0, 1).
  const double first_share = FirstRegionShare(sampler, part);
  const bool first = u.x < first_share;
  const double remapped = first ? u.x / first_share : (u.x - first_share) / (1 - first_share);
  const bool x_negative = first == (part == FilterPart::kNegative);
  const bool y_negative = !first;
  return {SampleDistance(x_negative ? sampler.negative : sampler.positive, remapped),
          SampleDistance(y_negative ? sampler.negative : sampler.positive, u.y)};
}

}  // namespace nacre
