// SPDX-License-Identifier: Apache-2.0
#include "table/direction_pairs.h"

#include <cmath>

namespace nacre {
namespace {

Vec3d DirectionOf(double theta_deg, double phi_deg) {
  if (theta_deg == 0) return {0, 0, 1};
  const double theta = theta_deg * M_PI / 180, phi = phi_deg * M_PI / 180;
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

}  // namespace

std::vector<DirectionPair> PairsOf(const DirectionGrid& grid) {
  std::vector<DirectionPair> pairs;
  for (const double light : grid.light_deg) {
    for (const double view : grid.view_deg) {
      for (const double phi : grid.phi_deg) {
        pairs.push_back(
            {DirectionOf(light, grid.view_phi_deg + phi), DirectionOf(view, grid.view_phi_deg)});
        if (light == 0) break;
      }
    }
  }
  return pairs;
}

}  // namespace nacre
