// SPDX-License-Identifier: Apache-2.0
// light/environment.cc: prepares an environment image for sampling.
#include "light/environment.h"

#include <algorithm>
#include <numeric>
#include <span>
#include <utility>

#include "base/parallel.h"

namespace nacre {
namespace {

EnvironmentRow RowEdges(int height, int row) {
  const double step = M_PI / height;
  const bool upper = 2 * row < height;
  // 1 - cos = 2 sin^2(theta / 2), with theta measured from the nearer pole.
  const auto one_minus_cos = [&](int edge) {
    const double sin = std::sin(step * (upper ? edge : height - edge) / 2);
    return static_cast<float>(2 * sin * sin);
  };
  return {one_minus_cos(row), one_minus_cos(row + 1), upper ? 1.0f : -1.0f};
}

// Returns the sum of the row's luminances.
double FillBlocks(std::span<const Vec3f> row, std::span<EnvironmentBlock> blocks) {
  double sum = 0;
  for (size_t i = 0; i < blocks.size(); ++i) {
    const size_t first = i * kEnvironmentBlock;
    for (const Vec3f& texel : row.subspan(first, std::min(kEnvironmentBlock, row.size() - first))) {
      sum += TexelLuminance(texel);
    }
    blocks[i].sum = sum;
  }
  // In a black row, which is never chosen, every quotient is NaN.
  size_t block = 0;
  for (size_t cell = 0; cell < blocks.size(); ++cell) {
    const double begin = static_cast<double>(cell) / static_cast<double>(blocks.size());
    while (block + 1 < blocks.size() && blocks[block].sum / sum <= begin) ++block;
    blocks[cell].first = static_cast<uint32_t>(block);
  }
  return sum;
}

}  // namespace

double TexelSolidAngle(int width, int height, int row) {
  // 2 pi / width times the difference of the edges' cosines.
  return 4 * M_PI / width * std::sin(M_PI * (row + 0.5) / height) * std::sin(M_PI / height / 2);
}

EnvironmentMap MakeEnvironmentMap(int width, int height, std::shared_ptr<const Vec3f[]> texels,
                                  int threads) {
  const auto columns = static_cast<size_t>(width), rows = static_cast<size_t>(height);
  EnvironmentMap map;
  map.width = width;
  map.height = height;
  map.texels = std::move(texels);
  map.row_blocks = (columns + kEnvironmentBlock - 1) / kEnvironmentBlock;
  map.blocks = HugeArray<EnvironmentBlock>(rows * map.row_blocks);
  map.row_sums.resize(rows);
  std::vector<double> row_weights(rows);
  constexpr size_t kRows = 16;  // per task
  ParallelForBlocks(rows, kRows, threads, [&](size_t begin, size_t end) {
    for (size_t y = begin; y < end; ++y) {
      EnvironmentBlock* const blocks = &map.blocks[y * map.row_blocks];
      const double sum = FillBlocks({&map.texels[static_cast<ptrdiff_t>(y * columns)], columns},
                                    {blocks, map.row_blocks});
      map.row_sums[y] = sum;
      row_weights[y] = sum * TexelSolidAngle(width, height, static_cast<int>(y));
    }
  });
  map.sum = std::accumulate(row_weights.begin(), row_weights.end(), 0.0);
  map.row_table = MakeInverseCdf(row_weights);
  map.is_black = !(map.sum > 0);
  for (int y = 0; y < height; ++y) map.rows.push_back(RowEdges(height, y));
  return map;
}

}  // namespace nacre
