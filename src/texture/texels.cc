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

// The weighted sums of neighbouring texels of a row, for each column of the smaller level.
void SumColumns(const std::vector<Cover>& columns, size_t channels, const double* row, float* out) {
  for (const Cover& column : columns) {
    const double* const first = row + static_cast<size_t>(column.first) * channels;
    for (size_t c = 0; c < channels; ++c) {
      double sum = 0;
      for (size_t k = 0; k < column.weights.size(); ++k) {
        sum += column.weights[k] * first[k * channels + c];
      }
      *out++ = static_cast<float>(sum);
    }
  }
}

// The same where each column is two texels wide, the usual case, to the same bits.
template <size_t kChannels>
void SumPairs(size_t columns, const double* row, float* out) {
  for (size_t x = 0; x < columns; ++x) {
    for (size_t c = 0; c < kChannels; ++c) {
      // With the 0 that the sum begins with: it makes -0 to 0.
      const double sum =
          (0.0 + 0.5 * row[2 * kChannels * x + c]) + 0.5 * row[2 * kChannels * x + kChannels + c];
      out[kChannels * x + c] = static_cast<float>(sum);
    }
  }
}

// Fills `level` from the one before it.
void FillLevel(size_t level, MipChain* chain) {
  const MipLevel& from = chain->levels[level - 1];
  const MipLevel& to = chain->levels[level];
  const auto channels = static_cast<size_t>(chain->channels);
  const std::vector<Cover> columns = CoversOf(from.width, to.width);
  const std::vector<Cover> rows = CoversOf(from.height, to.height);
  const size_t from_stride = static_cast<size_t>(from.width) * channels;
  const size_t to_stride = static_cast<size_t>(to.width) * channels;
  const float* const source = chain->values.data() + from.first;
  float* const target = chain->values.data() + to.first;
  std::vector<double> sums(from_stride);
  double* const column_sums = sums.data();
  for (size_t y = 0; y < rows.size(); ++y) {
    const Cover& row = rows[y];
    std::fill_n(column_sums, from_stride, 0.0);
    for (size_t k = 0; k < row.weights.size(); ++k) {
      const float* const line = source + (static_cast<size_t>(row.first) + k) * from_stride;
      for (size_t i = 0; i < from_stride; ++i) column_sums[i] += row.weights[k] * double{line[i]};
    }
    float* const out = target + y * to_stride;
    const auto width = static_cast<size_t>(to.width);
    if (from.width == 2 * to.width && channels == 3) {
      SumPairs<3>(width, column_sums, out);
    } else if (from.width == 2 * to.width && channels == 1) {
      SumPairs<1>(width, column_sums, out);
    } else {
      SumColumns(columns, channels, column_sums, out);
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
