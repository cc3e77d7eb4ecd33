// SPDX-License-Identifier: Apache-2.0
#include "texture/texels.h"

#include <algorithm>
#include <utility>

namespace nacre {
namespace {

// The texels of the larger level, along one axis, that a texel of the smaller level covers, and the
// weight of each.
struct Cover {
  int first = 0;
  std::vector<double> weights;  // their sum is 1
};

std::vector<Cover> CoversOf(int large, int small) {
  std::vector<Cover> covers(static_cast<size_t>(small));
  for (int i = 0; i < small; ++i) {
    // In units of 1 / small of a large texel, so that edges are integers and exact.
    const int64_t begin = int64_t{i} * large, end = begin + large;
    Cover& cover = covers[static_cast<size_t>(i)];
    cover.first = static_cast<int>(begin / small);
    for (int64_t texel = cover.first; texel * small < end; ++texel) {
      const int64_t from = std::max(begin, texel * small);
      const int64_t to = std::min(end, (texel + 1) * small);
      cover.weights.push_back(static_cast<double>(to - from) / large);
    }
  }
  return covers;
}

// Fills `level` from the one before it.
void FillLevel(size_t level, MipChain* chain) {
  const MipLevel& from = chain->levels[level - 1];
  const MipLevel& to = chain->levels[level];
  const auto channels = static_cast<size_t>(chain->channels);
  const std::vector<Cover> columns = CoversOf(from.width, to.width);
  const std::vector<Cover> rows = CoversOf(from.height, to.height);
  const size_t from_stride = static_cast<size_t>(from.width) * channels;
  const float* const source = chain->values.data() + from.first;
  float* out = chain->values.data() + to.first;
  std::vector<double> column_sums(from_stride);
  for (const Cover& row : rows) {
    std::fill(column_sums.begin(), column_sums.end(), 0.0);
    for (size_t k = 0; k < row.weights.size(); ++k) {
      const float* const line = source + (static_cast<size_t>(row.first) + k) * from_stride;
      for (size_t i = 0; i < from_stride; ++i) column_sums[i] += row.weights[k] * double{line[i]};
    }
    for (const Cover& column : columns) {
      const double* const first = column_sums.data() + static_cast<size_t>(column.first) * channels;
      for (size_t c = 0; c < channels; ++c) {
        double sum = 0;
        for (size_t k = 0; k < column.weights.size(); ++k) {
          sum += column.weights[k] * first[k * channels + c];
        }
        *out++ = static_cast<float>(sum);
      }
    }
  }
}

}  // namespace

MipChain MakeEmptyMipChain(int width, int height, int channels) {
  MipChain chain;
  chain.channels = channels;
  size_t total = 0;
  for (int w = width, h = height;; w = std::max(w / 2, 1), h = std::max(h / 2, 1)) {
    chain.levels.push_back({w, h, static_cast<int32_t>(total)});
    total += static_cast<size_t>(w) * static_cast<size_t>(h) * static_cast<size_t>(channels);
    if (w == 1 && h == 1) break;
  }
  chain.values.resize(total);
  return chain;
}

void FillMipLevels(MipChain* chain) {
  for (size_t level = 1; level < chain->levels.size(); ++level) FillLevel(level, chain);
}

MipChain MakeMipChain(int width, int height, int channels, std::vector<float> image) {
  MipChain chain = MakeEmptyMipChain(width, height, channels);
  std::copy(image.begin(), image.end(), chain.values.begin());
  FillMipLevels(&chain);
  return chain;
}

}  // namespace nacre
