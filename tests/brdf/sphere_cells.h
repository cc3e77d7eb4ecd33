// SPDX-License-Identifier: Apache-2.0
// tests/brdf/sphere_cells.h: cells of the sphere, by which samples of a lobe are counted.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "base/basis.h"

namespace nacre {

// Cells of the sphere in polar coordinates about a lobe's centre, evenly in t = angle / (angle +
// width) and azimuth.
struct SphereCells {
  static constexpr size_t kRings = 20, kSectors = 12;
  Basis<double> basis;
  double width;

  double MaxT() const { return M_PI / (M_PI + width); }

  size_t CellOf(const Vec3d& direction) const {
    const Vec3d local = basis.ToLocal(direction);
    const double sin = std::hypot(local.x, local.y);
    const double angle = std::atan2(sin, local.z);
    const double t = angle / (angle + width) / MaxT();
    const double turn = std::atan2(local.y, local.x) / (2 * M_PI) + 0.5;
    const auto ring = std::min(static_cast<size_t>(t * kRings), kRings - 1);
    const auto sector = std::min(static_cast<size_t>(turn * kSectors), kSectors - 1);
    return ring * kSectors + sector;
  }

  // The integral of the pdf over each cell, by the midpoint rule of steps^2 points.
  std::vector<double> Integrate(const std::function<double(const Vec3d&)>& pdf, int steps) const {
    std::vector<double> integrals(kRings * kSectors);
    const auto rings = static_cast<int>(kRings) * steps;
    const auto sectors = static_cast<int>(kSectors) * steps;
    std::vector<double> cos_phi, sin_phi;
    for (int j = 0; j < sectors; ++j) {
      const double phi = ((j + 0.5) / sectors - 0.5) * 2 * M_PI;
      cos_phi.push_back(std::cos(phi));
      sin_phi.push_back(std::sin(phi));
    }
    for (int i = 0; i < rings; ++i) {
      const double t = (i + 0.5) / rings * MaxT();
      const double angle = width * t / (1 - t);
      const double d_angle = width / ((1 - t) * (1 - t)) * MaxT() / rings;
      const double sin = std::sin(angle), cos = std::cos(angle);
      const double area = sin * d_angle * 2 * M_PI / sectors;
      for (int j = 0; j < sectors; ++j) {
        const auto k = static_cast<size_t>(j);
        const Vec3d direction = basis.ToWorld({sin * cos_phi[k], sin * sin_phi[k], cos});
        integrals[static_cast<size_t>(i / steps) * kSectors + static_cast<size_t>(j / steps)] +=
            pdf(direction) * area;
      }
    }
    return integrals;
  }
};

}  // namespace nacre
