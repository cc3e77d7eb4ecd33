// SPDX-License-Identifier: Apache-2.0
// light/harmonics.cc: projects an environment's image.
#include "light/harmonics.h"

#include "base/parallel.h"

namespace nacre {
namespace {

// Sine and cosine of a longitude.
struct Longitude {
  double sin, cos;
};

constexpr double kPoints[] = {-0.7745966692414834, 0, 0.7745966692414834};
constexpr double kWeights[] = {5.0 / 18, 8.0 / 18, 5.0 / 18};

// Gauss' three points of every column.
std::vector<Longitude> MakeLongitudes(int width) {
  std::vector<Longitude> longitudes;
  longitudes.reserve(3 * static_cast<size_t>(width));
  for (int x = 0; x < width; ++x) {
    for (const double point : kPoints) {
      const double phi = 2 * M_PI * (x + (point + 1) / 2) / width;
      longitudes.push_back({std::sin(phi), std::cos(phi)});
    }
  }
  return longitudes;
}

// The mean of the basis over a texel, by Gauss' rule of three points each way: of a polynomial of
// degree 2 in sines and cosines of an angle under half a turn, so for images of two columns or more
// far below rounding of floats, and of the smallest images to 1e-4.
HarmonicBasis<double> TexelHarmonics(const EnvironmentRow& row, const Longitude* longitudes) {
  HarmonicBasis<double> mean{};
  for (int i = 0; i < 3; ++i) {
    const double t = row.first + (kPoints[i] + 1) / 2 * (double{row.last} - row.first);
    const double sin = std::sqrt(t * (2 - t));
    for (int j = 0; j < 3; ++j) {
      const HarmonicBasis<double> basis = EvaluateHarmonics<double>(
          {longitudes[j].sin * sin, row.sign * (1 - t), -longitudes[j].cos * sin});
      for (size_t k = 0; k < kHarmonics; ++k) mean[k] += kWeights[i] * kWeights[j] * basis[k];
    }
  }
  return mean;
}

using RowSum = std::array<Vec3d, kHarmonics>;

// The integral of radiance times basis over a row.
RowSum SumRow(const EnvironmentMap& map, size_t y, const std::vector<Longitude>& longitudes) {
  RowSum sum;
  sum.fill(Vec3d(0));
  const auto width = static_cast<size_t>(map.width);
  for (size_t x = 0; x < width; ++x) {
    const EnvironmentTexel& texel = map.texels[y * width + x];
    const Vec3d radiance(texel.red, texel.green, texel.blue);
    const HarmonicBasis<double> basis = TexelHarmonics(map.rows[y], &longitudes[3 * x]);
    for (size_t k = 0; k < kHarmonics; ++k) sum[k] += radiance * basis[k];
  }
  const double solid_angle = TexelSolidAngle(map.width, map.height, static_cast<int>(y));
  for (Vec3d& coefficient : sum) coefficient *= solid_angle;
  return sum;
}

}  // namespace

IrradianceHarmonics<double> ProjectIrradiance(const EnvironmentMap& map, int threads) {
  constexpr double kCosine[] = {M_PI, 2 * M_PI / 3, M_PI / 4};
  constexpr size_t kOrder[kHarmonics] = {0, 1, 1, 1, 2, 2, 2, 2, 2};
  const std::vector<Longitude> longitudes = MakeLongitudes(map.width);
  std::vector<RowSum> rows(static_cast<size_t>(map.height));
  ParallelFor(rows.size(), threads, [&](size_t y) { rows[y] = SumRow(map, y, longitudes); });
  IrradianceHarmonics<double> harmonics;
  harmonics.coefficients.fill(Vec3d(0));
  for (const RowSum& row : rows) {
    for (size_t k = 0; k < kHarmonics; ++k) {
      harmonics.coefficients[k] += row[k] * kCosine[kOrder[k]];
    }
  }
  return harmonics;
}

}  // namespace nacre
