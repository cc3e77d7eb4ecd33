// SPDX-License-Identifier: Apache-2.0
// tests/light/area_shapes.h: area lights in positions that are numerically hard.
#pragma once

#include <vector>

#include "light/disk_light.h"
#include "light/rectangle_light.h"
#include "light/sphere_light.h"
#include "light/triangle_light.h"

namespace nacre {

// A rotation that makes no component special.
inline Vec3d Turn(const Vec3d& v) {
  const Basis<double> basis = BasisAbout(Vec3d(0.3, -0.8, 0.5).normalized());
  return basis.ToWorld(v);
}

inline std::vector<SphereLight<double>> SphereLights() {
  return {{Turn({1, 2, 3}), 0.5},
          {Turn({0, 0, 2000}), 1},        // 8e-7 sr
          {Turn({0, 0, 1}), 0.999999},    // nearly touching
          {Turn({0, 0.5, 1}), 3},         // from inside
          {Turn({0, 0, -1e-3}), 10},      // next to the centre
          {{0, 0, -5}, 1},                // down the axis where bases break
          {Turn({3e5, 1e5, 2e5}), 1e4}};  // large numbers
}

// Rectangles that face the point, that are distant, nearby, edge-on, to one side, long and thin.
inline std::vector<RectangleLight<double>> RectangleLights() {
  const auto make = [](const Vec3d& corner, double width, double height) {
    return RectangleLight<double>{Turn(corner), Turn({width, 0, 0}), Turn({0, height, 0})};
  };
  return {make({-0.5, -1, -2}, 1, 2),
          make({300, -400, 900}, 1, 2),         // 2e-6 sr
          make({-30, -20, 0.1}, 70, 50),        // nearly the half-space
          make({-0.5, -0.3, -1e-3}, 1, 1),      // over the point
          make({5, 3, 0.05}, 2, 2),             // seen edge-on
          make({10, 0.5, 3}, 4, 0.01),          // a strip
          make({1, 2, -3}, 0.05, 3),            // another
          make({0, 0, 1}, 1, 1),                // a corner overhead
          make({-8, -7, 2}, 3, 4),              // both coordinates negative
          make({0.1, 0.1, 1}, 0.011, 0.0101)};  // just above kSmallSolidAngle
}

inline std::vector<TriangleLight<double>> TriangleLights() {
  const auto make = [](const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    return TriangleLight<double>{Turn(a), Turn(b - a), Turn(c - a)};
  };
  return {make({-0.5, -1, 2}, {1, 0, 2.5}, {0, 1.5, 1}),
          make({300, 400, 900}, {301, 400, 900}, {300, 402, 900.5}),  // 1e-6 sr
          make({-50, -40, 0.1}, {60, -40, 0.1}, {0, 80, 0.1}),        // nearly the half-space
          make({5, 3, 0.05}, {7, 3, 0.05}, {6, 6, 0.2}),              // edge-on
          make({1, 0, 0.2}, {0, 1, 0.3}, {-1, -1, 0.1}),              // around
          make({1, 2, -3}, {1.001, 2, -3}, {1, 9, -3}),               // a sliver
          make({0.1, 0, 1}, {0.12, 0.01, 1}, {0.1, 0.02, 1.01})};
}

inline std::vector<DiskLight<double>> DiskLights() {
  const Vec3d up = Turn({0, 0, 1});
  return {{Turn({1, 2, 3}), up, 0.5},
          {Turn({30, 10, -2000}), up, 1},  // 8e-7 sr, behind
          {Turn({0.2, 0.1, 0.5}), up, 1},  // nearby
          {Turn({0, 0.01, 1e-3}), up, 1},  // near the axis, very near
          {Turn({1.05, 0, 0.02}), up, 1},  // beside the rim
          {Turn({0.1, 0, 1}), up, 1},      // near the axis
          {Turn({4, 3, 0.02}), up, 1},     // edge-on
          {Turn({2, 0, -1}), Turn({0.6, 0, 0.8}), 1.5}};
}

}  // namespace nacre
