// SPDX-License-Identifier: Apache-2.0
#include "compare/flip_hdr.h"

#include <algorithm>
#include <cmath>

#include "color/luminance.h"
#include "color/tone.h"

namespace nacre {
namespace {

// The pre-exposure that Narkowicz cancels in his text: with it, curve(1) is 0.8.
constexpr double kPreExposure = 0.6;
constexpr double kShown = 0.85;  // of white: t_max and t_min

// The radiance that the tone curve shows as `light`: the positive root of its quadratic.
double RadianceShownAs(double light) {
  const double a = 2.51 - 2.43 * light;
  const double b = 0.03 - 0.59 * light;
  const double c = -0.14 * light;
  return (-b + std::sqrt(b * b - 4 * a * c)) / (2 * a) / kPreExposure;
}

double Median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return (*std::max_element(values.begin(), middle) + *middle) / 2;
}

Planes Show(const Planes& radiance, double exposure) {
  Planes shown = radiance;
  for (Plane& plane : shown) {
    for (double& value : plane.values) {
      value = ToneAces(kPreExposure * std::exp2(exposure) * value);
    }
  }
  return shown;
}

}  // namespace

ExposureRange FlipExposures(const Planes& reference) {
  std::vector<double> luminances;
  luminances.reserve(reference[0].size());
  for (size_t i = 0; i < reference[0].size(); ++i) {
    luminances.push_back(Luminance<double>(
        {reference[0].values[i], reference[1].values[i], reference[2].values[i]}));
  }
  const double brightest = *std::max_element(luminances.begin(), luminances.end());
  if (brightest == 0) return {};
  double median = Median(luminances);
  if (median == 0) {
    std::erase(luminances, 0.0);
    median = Median(luminances);
  }
  const double radiance = RadianceShownAs(kShown);
  ExposureRange range;
  range.start = std::log2(radiance / brightest);
  range.stop = std::log2(radiance / median);
  range.count = std::max(2, static_cast<int>(std::ceil(range.stop - range.start)));
  return range;
}

HdrFlip HdrFlipMap(const Planes& reference, const Planes& test, const ExposureRange& range,
                   double pixels_per_degree) {
  const double step = range.count > 1 ? (range.stop - range.start) / (range.count - 1) : 0;
  HdrFlip out{Plane(reference[0].width, reference[0].height),
              Plane(reference[0].width, reference[0].height, range.start)};
  for (int i = 0; i < range.count; ++i) {
    const double exposure = range.start + i * step;
    const Plane error = FlipMap(Show(reference, exposure), Show(test, exposure), pixels_per_degree);
    for (size_t p = 0; p < error.size(); ++p) {
      if (error.values[p] <= out.error.values[p]) continue;
      out.error.values[p] = error.values[p];
      out.exposure.values[p] = exposure;
    }
  }
  return out;
}

}  // namespace nacre
