// SPDX-License-Identifier: Apache-2.0
// light/prefilter.h: an environment's image as a GGX lobe blurs it, by the direction in which a
// mirror would look: one half of the split sum (Karis 2013, "Real Shading in Unreal Engine 4"),
// whose other half is the lobe's albedo.
//
// The lobe is that of a surface seen along its normal, wherever the surface looks: for width
// alpha, a direction at the angle t from the mirror's counts D(cos(t/2)) cos t. So it is round, and
// the integral a convolution, computed whole: no samples, no noise. What is wrong with it, lobes
// that stretch or are cut by the horizon, is left to be measured.
#pragma once

#include <vector>

#include "light/environment.h"

namespace nacre {

// Narrower lobes would see the parts of the image, 2.8 degrees (180 / 64), that they are made of:
// half of the light of this one is within 10 degrees.
inline constexpr double kLeastPrefilterAlpha = 0.09;

// The parts that the image is taken in: so many rows, and twice as many columns.
inline constexpr int kPrefilterRows = 64;

// Radiance at the crossings of rows + 1 latitudes, both poles included, and 2 rows longitudes.
// Their steps are a fifth of the lobe's width or less: bilinear look-ups see no corners.
struct PrefilteredMap {
  double alpha = 0;
  int rows = 0;
  std::vector<Vec3f> texels;
};

// alpha >= kLeastPrefilterAlpha. The same on any number of threads.
PrefilteredMap Prefilter(const EnvironmentMap& map, double alpha, int threads = 1);

// Bilinear in latitude and longitude, u and v in [0, 1].
template <typename Real>
Imath::Vec3<Real> LookUp(const PrefilteredMap& map, Real u, Real v) {
  const int columns = 2 * map.rows;
  u *= static_cast<Real>(columns);
  v *= static_cast<Real>(map.rows);
  const int x = std::min(static_cast<int>(u), columns - 1);
  const int y = std::min(static_cast<int>(v), map.rows - 1);
  const Real s = u - static_cast<Real>(x), t = v - static_cast<Real>(y);
  const int next = x + 1 < columns ? x + 1 : 0;
  const auto texel = [&](int column, int row) {
    return Imath::Vec3<Real>(map.texels[static_cast<size_t>(row * columns + column)]);
  };
  const Imath::Vec3<Real> upper = texel(x, y) * (1 - s) + texel(next, y) * s;
  const Imath::Vec3<Real> lower = texel(x, y + 1) * (1 - s) + texel(next, y + 1) * s;
  return upper * (1 - t) + lower * t;
}
template <typename Real>
Imath::Vec3<Real> LookUp(const PrefilteredMap& map, const Imath::Vec3<Real>& direction) {
  const LatLong<Real> at = LatLongFromDirection(direction);
  return LookUp(map, at.u, at.v);
}

}  // namespace nacre
