// SPDX-License-Identifier: Apache-2.0
// tests/compare/flip_twin.h: FLIP and HDR-FLIP in double, plane after plane, as the papers have
// them: what the kernels of src/compare are held to. It is held to the authors' formulas itself
// (tables/flip.json).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "color/tone.h"
#include "compare/flip.h"
#include "compare/flip_color.h"
#include "compare/flip_rows.h"

namespace nacre::flip_twin {

struct ExactPlane {
  int width = 0, height = 0;
  std::vector<double> values;

  ExactPlane() = default;
  ExactPlane(int w, int h, double value = 0)
      : width(w), height(h), values(static_cast<size_t>(w) * static_cast<size_t>(h), value) {}
  double& at(int x, int y) { return values[static_cast<size_t>(y * width + x)]; }
  double at(int x, int y) const { return values[static_cast<size_t>(y * width + x)]; }
  size_t size() const { return values.size(); }
};
using ExactPlanes = std::array<ExactPlane, 3>;

// Correlates the rows with `across` and the columns with `down`. Beyond its edge the picture goes
// on as its edge is, so that there is no smallest size.
inline ExactPlane Filter(const ExactPlane& plane, const Kernel& across, const Kernel& down) {
  const auto filter = [](const ExactPlane& in, const Kernel& kernel, int step_x, int step_y) {
    const int radius = static_cast<int>(kernel.size() / 2);
    ExactPlane out(in.width, in.height);
    for (int y = 0; y < in.height; ++y) {
      for (int x = 0; x < in.width; ++x) {
        for (int i = -radius; i <= radius; ++i) {
          out.at(x, y) += kernel[static_cast<size_t>(i + radius)] *
                          in.at(std::clamp(x + i * step_x, 0, in.width - 1),
                                std::clamp(y + i * step_y, 0, in.height - 1));
        }
      }
    }
    return out;
  };
  return filter(filter(plane, across, 1, 0), down, 0, 1);
}

inline ExactPlanes Map(ExactPlanes planes, flip::Triple (*function)(const flip::Triple&)) {
  for (size_t i = 0; i < planes[0].size(); ++i) {
    const flip::Triple to =
        function({planes[0].values[i], planes[1].values[i], planes[2].values[i]});
    for (size_t c = 0; c < 3; ++c) planes[c].values[i] = to[c];
  }
  return planes;
}

inline ExactPlanes SeenColors(const ExactPlanes& ycc, const FlipFilters& filters) {
  ExactPlanes filtered = {Filter(ycc[0], filters.luminance, filters.luminance),
                          Filter(ycc[1], filters.red_green, filters.red_green),
                          Filter(ycc[2], filters.blue_yellow[0], filters.blue_yellow[0])};
  const ExactPlane second = Filter(ycc[2], filters.blue_yellow[1], filters.blue_yellow[1]);
  for (size_t i = 0; i < second.size(); ++i) {
    filtered[2].values[i] = std::lerp(second.values[i], filtered[2].values[i], filters.first_share);
  }
  return Map(filtered, flip::SeenColor);
}

// The size of the gradient (edges) or of the second derivatives (points).
inline ExactPlane FeatureSize(const ExactPlane& y, const Kernel& derivative, const Kernel& smooth) {
  ExactPlane luminance = y;
  for (double& value : luminance.values) value = (value + 16) / 116;
  ExactPlane size = Filter(luminance, derivative, smooth);
  const ExactPlane down = Filter(luminance, smooth, derivative);
  for (size_t i = 0; i < size.size(); ++i) {
    size.values[i] = std::hypot(size.values[i], down.values[i]);
  }
  return size;
}

inline ExactPlane FlipMap(const ExactPlanes& reference, const ExactPlanes& test,
                          double pixels_per_degree) {
  const FlipFilters filters = MakeFlipFilters(pixels_per_degree);
  const double largest = flip::LargestDifference();
  const ExactPlanes a = Map(reference, flip::YccFromRgb), b = Map(test, flip::YccFromRgb);
  const ExactPlanes seen_a = SeenColors(a, filters), seen_b = SeenColors(b, filters);
  const ExactPlane edges_a = FeatureSize(a[0], filters.edge, filters.smooth);
  const ExactPlane edges_b = FeatureSize(b[0], filters.edge, filters.smooth);
  const ExactPlane points_a = FeatureSize(a[0], filters.point, filters.smooth);
  const ExactPlane points_b = FeatureSize(b[0], filters.point, filters.smooth);
  ExactPlane map(reference[0].width, reference[0].height);
  for (size_t i = 0; i < map.size(); ++i) {
    const auto at = [i](const ExactPlanes& p) -> flip::Triple {
      return {p[0].values[i], p[1].values[i], p[2].values[i]};
    };
    map.values[i] =
        flip::Flip(flip::ColorError(flip::HyabDistance(at(seen_a), at(seen_b)), largest),
                   flip::FeatureError(edges_a.values[i] - edges_b.values[i],
                                      points_a.values[i] - points_b.values[i]));
  }
  return map;
}

inline ExactPlane HdrFlipMap(const ExactPlanes& reference, const ExactPlanes& test,
                             const ExposureRange& range, double pixels_per_degree) {
  const double step = range.count > 1 ? (range.stop - range.start) / (range.count - 1) : 0;
  ExactPlane largest(reference[0].width, reference[0].height);
  for (int i = 0; i < range.count; ++i) {
    const auto show = [&](ExactPlanes planes) {
      for (ExactPlane& plane : planes) {
        for (double& value : plane.values) {
          value = ToneAces(0.6 * std::exp2(range.start + i * step) * value);
        }
      }
      return planes;
    };
    const ExactPlane map = FlipMap(show(reference), show(test), pixels_per_degree);
    for (size_t p = 0; p < map.size(); ++p) {
      largest.values[p] = std::max(largest.values[p], map.values[p]);
    }
  }
  return largest;
}

}  // namespace nacre::flip_twin
