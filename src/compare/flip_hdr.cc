// SPDX-License-Identifier: Apache-2.0
#include "compare/flip_hdr.h"

#include <algorithm>
#include <cmath>

#include "color/display.h"
#include "color/luminance.h"

namespace nacre {
namespace {

// The pre-exposure that Narkowicz cancels in his text; with it, curve(1) is 0.8.
constexpr double kPreExposure = 0.6;
constexpr double kShown = 0.85;  // of white; for t_max and t_min

// The radiance that the tone curve maps to `light`: the positive root of its quadratic.
double RadianceShownAs(double light) {
  const double a = 2.51 - 2.43 * light;
  const double b = 0.03 - 0.59 * light;
  const double c = -0.14 * light;
  return (-b + std::sqrt(b * b - 4 * a * c)) / (2 * a) / kPreExposure;
}

double Median(std::vector<double>* values) {
  const auto middle = values->begin() + static_cast<std::ptrdiff_t>(values->size() / 2);
  std::nth_element(values->begin(), middle, values->end());
  if (values->size() % 2 == 1) return *middle;
  return (*std::max_element(values->begin(), middle) + *middle) / 2;
}

ShowPair ShowAt(double exposure) {
  // Limited to float's range, which references that consist of denormals would exceed.
  const double stops = std::clamp(exposure + std::log2(kPreExposure), -126.0, 127.0);
  const DisplaySettings display{.tone = ToneOperator::kAces, .exposure_ev = stops};
  const ShowFunction show = [display](size_t count, float* r, float* g, float* b) {
    ShowLight(display, count, r, g, b);
  };
  return {show, show, /*alike=*/true};
}

}  // namespace

ExposureRange FlipExposures(const PictureView& reference) {
  std::vector<double> luminances;
  luminances.reserve(static_cast<size_t>(reference.width) * static_cast<size_t>(reference.height));
  for (int y = 0; y < reference.height; ++y) {
    const size_t row = static_cast<size_t>(y) * reference.stride;
    for (size_t i = row; i < row + static_cast<size_t>(reference.width); ++i) {
      const auto at = [&](size_t c) { return std::max(double{reference.rgb[c][i]}, 0.0); };
      luminances.push_back(Luminance<double>({at(0), at(1), at(2)}));
    }
  }
  const double brightest = *std::max_element(luminances.begin(), luminances.end());
  if (brightest == 0) return {};
  double median = Median(&luminances);
  if (median == 0) {
    std::erase(luminances, 0.0);
    median = Median(&luminances);
  }
  const double radiance = RadianceShownAs(kShown);
  ExposureRange range;
  range.start = std::log2(radiance / brightest);
  range.stop = std::log2(radiance / median);
  range.count = std::max(2, static_cast<int>(std::ceil(range.stop - range.start)));
  return range;
}

Plane HdrFlipMap(const PictureView& reference, const PictureView& test, const ExposureRange& range,
                 double pixels_per_degree) {
  const double step = range.count > 1 ? (range.stop - range.start) / (range.count - 1) : 0;
  std::vector<ShowPair> shows;
  for (int i = 0; i < range.count; ++i) shows.push_back(ShowAt(range.start + i * step));
  return FlipMap(reference, test, shows, pixels_per_degree);
}

}  // namespace nacre
