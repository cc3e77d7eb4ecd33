// SPDX-License-Identifier: Apache-2.0
// light/environment.cc: prepares an environment image for sampling.
#include "light/environment.h"

#include <numeric>

#include "base/float_mode.h"
#include "base/parallel.h"
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

EnvironmentMap MakeEnvironmentMap(int width, int height, std::span<const Vec3f> texels,
                                  int threads) {
  EnvironmentMap map;
  map.width = width;
  map.height = height;
  map.texels = HugeArray<EnvironmentTexel>(texels.size());
  map.column_tables = HugeArray<CdfEntry>(texels.size());
  const auto columns = static_cast<size_t>(width), rows = static_cast<size_t>(height);
  std::vector<double> row_weights(rows);
  constexpr size_t kRows = 16;  // at a time
  // Calls body(y, luminances) for all rows, on several threads.
  const auto for_each_row = [&](const auto& body) {
    ParallelFor((rows + kRows - 1) / kRows, threads, [&](size_t block) {
      const DefaultFloatMode mode;  // texels may be denormal
      std::vector<double> luminances(columns);
      for (size_t y = block * kRows; y < std::min(rows, (block + 1) * kRows); ++y) {
        for (size_t x = 0; x < columns; ++x) {
          const Vec3f& t = texels[y * columns + x];
          luminances[x] = Luminance(Rgb(t.x, t.y, t.z));
        }
        body(y, luminances);
      }
    });
  };
  for_each_row([&](size_t y, const std::vector<double>& luminances) {
    const double row_sum = std::accumulate(luminances.begin(), luminances.end(), 0.0);
    row_weights[y] = row_sum * TexelSolidAngle(width, height, static_cast<int>(y));
    FillInverseCdf(luminances, &map.column_tables[y * columns]);
  });
  const double sum = std::accumulate(row_weights.begin(), row_weights.end(), 0.0);
  map.row_table = MakeInverseCdf(row_weights);
  map.is_black = !(sum > 0);
  for (int y = 0; y < height; ++y) map.rows.push_back(RowEdges(height, y));
  for_each_row([&](size_t y, const std::vector<double>& luminances) {
    for (size_t x = 0; x < columns; ++x) {
      const Vec3f& t = texels[y * columns + x];
      // Luminance times solid angle over its sum, per solid angle.
      const double pdf = map.is_black ? 0 : static_cast<float>(luminances[x]) / sum;
      map.texels[y * columns + x] = {t.x, t.y, t.z, static_cast<float>(pdf)};
    }
  });
  return map;
}

}  // namespace nacre
