// light/harmonics.cc: projects an environment's image.
#include "light/harmonics.h"

namespace nacre {
namespace {

// The mean of the basis over a texel, by Gauss' rule of three points each way: of a polynomial of
// degree 2 in sines and cosines of an angle under half a turn, so for images of two columns or more
// far below rounding of floats, and of the smallest images to 1e-4.
HarmonicBasis<double> TexelHarmonics(const EnvironmentMap& map, int x, int y) {
  constexpr double kPoints[] = {-0.7745966692414834, 0, 0.7745966692414834};
  constexpr double kWeights[] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
  const EnvironmentRow& row = map.rows[static_cast<size_t>(y)];
  HarmonicBasis<double> mean{};
  for (int i = 0; i < 3; ++i) {
    const double t = row.first + (kPoints[i] + 1) / 2 * (double{row.last} - row.first);
    const double sin = std::sqrt(t * (2 - t));
    for (int j = 0; j < 3; ++j) {
      const double phi = 2 * M_PI * (x + (kPoints[j] + 1) / 2) / map.width;
      const HarmonicBasis<double> basis = EvaluateHarmonics<double>(
          {std::sin(phi) * sin, row.sign * (1 - t), -std::cos(phi) * sin});
      for (size_t k = 0; k < kHarmonics; ++k) mean[k] += kWeights[i] * kWeights[j] * basis[k];
    }
  }
  return mean;
}

}  // namespace

IrradianceHarmonics<double> ProjectIrradiance(const EnvironmentMap& map) {
  constexpr double kCosine[] = {M_PI, 2 * M_PI / 3, M_PI / 4};
  constexpr size_t kOrder[kHarmonics] = {0, 1, 1, 1, 2, 2, 2, 2, 2};
  IrradianceHarmonics<double> harmonics;
  harmonics.coefficients.fill(Vec3d(0));
  for (int y = 0; y < map.height; ++y) {
    const double solid_angle = TexelSolidAngle(map.width, map.height, y);
    for (int x = 0; x < map.width; ++x) {
      const EnvironmentTexel& texel =
          map.texels[static_cast<size_t>(y) * static_cast<size_t>(map.width) +
                     static_cast<size_t>(x)];
      const Vec3d radiance(texel.red, texel.green, texel.blue);
      const HarmonicBasis<double> basis = TexelHarmonics(map, x, y);
      for (size_t k = 0; k < kHarmonics; ++k) {
        harmonics.coefficients[k] += radiance * (solid_angle * basis[k] * kCosine[kOrder[k]]);
      }
    }
  }
  return harmonics;
}

}  // namespace nacre
