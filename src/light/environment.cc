// SPDX-License-Identifier: Apache-2.0
// light/environment.cc: prepares an environment image for sampling.
#include "light/environment.h"

#include "color/luminance.h"

namespace nacre {
namespace {

EnvironmentRow RowEdges(int height, int row) {
  const double step = M_PI / height;
  const bool upper = 2 * row < height;
  // 1 - cos = 2 sin^2(half the angle), from the nearer pole.
  const auto one_minus_cos = [&](int edge) {
    const double sin = std::sin(step * (upper ? edge : height - edge) / 2);
    return static_cast<float>(2 * sin * sin);
  };
  return {one_minus_cos(row), one_minus_cos(row + 1), upper ? 1.0f : -1.0f};
}

}  // namespace

double TexelSolidAngle(int width, int height, int row) {
  // 2 pi / width times the difference of the edges' cosines.
  return 4 * M_PI / width * std::sin(M_PI * (row + 0.5) / height) * std::sin(M_PI / height / 2);
}

EnvironmentMap MakeEnvironmentMap(int width, int height, std::span<const Vec3f> texels) {
  EnvironmentMap map;
  map.width = width;
  map.height = height;
  map.texels.reserve(texels.size());
  map.column_tables.reserve(texels.size());
  map.rows.reserve(static_cast<size_t>(height));
  std::vector<double> row_weights, luminances(static_cast<size_t>(width));
  row_weights.reserve(static_cast<size_t>(height));
  double sum = 0;
  for (int y = 0; y < height; ++y) {
    double row_sum = 0;
    for (size_t x = 0; x < luminances.size(); ++x) {
      const Vec3f& t = texels[static_cast<size_t>(y) * luminances.size() + x];
      luminances[x] = Luminance(Rgb(t.x, t.y, t.z));
      row_sum += luminances[x];
      map.texels.push_back({t.x, t.y, t.z, static_cast<float>(luminances[x])});
    }
    const std::vector<CdfEntry> columns = MakeInverseCdf(luminances);
    map.column_tables.insert(map.column_tables.end(), columns.begin(), columns.end());
    map.rows.push_back(RowEdges(height, y));
    row_weights.push_back(row_sum * TexelSolidAngle(width, height, y));
    sum += row_weights.back();
  }
  map.row_table = MakeInverseCdf(row_weights);
  map.is_black = !(sum > 0);
  // Luminance times solid angle over its sum, per solid angle.
  for (EnvironmentTexel& texel : map.texels) {
    texel.pdf = map.is_black ? 0 : static_cast<float>(texel.pdf / sum);
  }
  return map;
}

}  // namespace nacre
