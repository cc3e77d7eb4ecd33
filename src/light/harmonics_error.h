// SPDX-License-Identifier: Apache-2.0
// light/harmonics_error.h: how far irradiance from harmonics is from that of all of an image's
// texels. It is a property of the image, so it is measured, not promised.
#pragma once

#include <vector>

#include "light/harmonics.h"

namespace nacre {

// The light from a small part of the sphere, a channel each: the integral of radiance times
// direction, whose product with a normal is the irradiance on a surface that sees all of the part.
struct LightCell {
  Vec3d red{0, 0, 0}, green{0, 0, 0}, blue{0, 0, 0};
};

// An image in cells of at most 1.41 degrees (180 / 128) each way, of texels' parts or of several
// texels.
std::vector<LightCell> MakeLightCells(const EnvironmentMap& map, int threads = 1);

// Exact but for cells that the surface's horizon cuts, each of which is off by at most 0.0045 of
// its light at normal incidence: a quarter of the sine of half its diagonal.
Vec3d Irradiance(const std::vector<LightCell>& cells, const Vec3d& normal);

// Differences between harmonics and cells at normals all round, as parts of the mean of the
// irradiance over these normals: a channel each, and together.
struct HarmonicsError {
  size_t normals = 0;
  double rms = 0, worst = 0;
};

HarmonicsError MeasureHarmonics(const EnvironmentMap& map,
                                const IrradianceHarmonics<double>& harmonics, int threads = 1);

}  // namespace nacre
