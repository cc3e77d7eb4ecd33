// SPDX-License-Identifier: Apache-2.0
// shading/lobe_width.h: the width of the lobe around the mirror direction, of models of which
// nothing is known but their values.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "base/vec.h"

namespace nacre {

// Pairs of directions above the surface whose half vectors lie at growing angles from the normal.
struct LobeWidthPairs {
  static constexpr size_t kCount = 48;
  Vec3d normal{0, 0, 1}, to_view{0, 0, 1};
  std::array<Vec3d, kCount> to_light;
};

// The approximate angle between half vector and normal, in radians, at which the lobe around the
// mirror direction has fallen to 1/e; infinite for a model that changes little within half a
// radian. evaluate(pairs, &values) stores the BRDF of all pairs. Highlights elsewhere, and edges,
// go unnoticed.
template <class Evaluate>
double FindLobeWidth(const Evaluate& evaluate) {
  // The half vector is tilted perpendicular to the plane of incidence, so that the light stays
  // above the surface.
  constexpr size_t kAngles = LobeWidthPairs::kCount;
  constexpr double kLargest = 0.5;
  double angle[kAngles] = {};  // the first is 0
  for (size_t k = 1; k < kAngles; ++k) {
    angle[k] = kLargest * std::exp2(-0.5 * static_cast<double>(kAngles - 1 - k));
  }
  double width = std::numeric_limits<double>::infinity();
  LobeWidthPairs pairs;
  std::array<Vec3d, kAngles> values;
  for (const double view_angle : {0.2, 1.0}) {
    pairs.to_view = Vec3d(-std::sin(view_angle), 0, std::cos(view_angle));
    for (size_t k = 0; k < kAngles; ++k) {
      const Vec3d half(0, std::sin(angle[k]), std::cos(angle[k]));
      pairs.to_light[k] = (2 * pairs.to_view.dot(half) * half - pairs.to_view).normalized();
    }
    evaluate(pairs, &values);
    for (int c = 0; c < 3; ++c) {
      double change = 0, largest = 0;
      for (size_t k = 0; k < kAngles; ++k) {
        change = std::max(change, std::abs(values[k][c] - values[0][c]));
        largest = std::max(largest, std::abs(values[k][c]));
      }
      if (!(change > 1e-3 * largest)) continue;
      size_t k = 0;
      while (!(std::abs(values[k][c] - values[0][c]) > (1 - 1 / M_E) * change)) ++k;
      width = std::min(width, angle[k]);
    }
  }
  return width;
}

}  // namespace nacre
