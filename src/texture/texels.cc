// SPDX-License-Identifier: Apache-2.0
#include "texture/texels.h"

#include <algorithm>
#include <bit>
#include <optional>
#include <utility>

#include <Imath/half.h>

#include "base/float_mode.h"

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

// Stores the weighted sums of neighbouring texels of a row, for each column of the smaller level.
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

// Makes the level after `from`, of size `to`.
HugeVector<float> MakeNextLevel(const TexelView& from, const MipLevel& to) {
  const auto channels = static_cast<size_t>(from.channels);
  const std::vector<Cover> columns = CoversOf(from.width, to.width);
  const std::vector<Cover> rows = CoversOf(from.height, to.height);
  const size_t from_stride = static_cast<size_t>(from.width) * channels;
  const auto width = static_cast<size_t>(to.width);
  HugeVector<float> values(rows.size() * width * channels);
  std::vector<float> line(from_stride);
  std::vector<double> sums(from_stride);
  double* const column_sums = sums.data();
  for (size_t y = 0; y < rows.size(); ++y) {
    const Cover& row = rows[y];
    std::fill_n(column_sums, from_stride, 0.0);
    for (size_t k = 0; k < row.weights.size(); ++k) {
      from.Read((static_cast<size_t>(row.first) + k) * from_stride, line);
      for (size_t i = 0; i < from_stride; ++i) column_sums[i] += row.weights[k] * double{line[i]};
    }
    SumColumns(columns, channels, column_sums, values.data() + y * width * channels);
  }
  return values;
}

// The table of the values value_of(code), rounded to float once.
template <class ValueOf>
TexelTable MakeTable(int codes, const ValueOf& value_of) {
  auto table = std::make_shared<std::vector<float>>();
  for (int code = 0; code < codes; ++code) table->push_back(static_cast<float>(value_of(code)));
  return table;
}

TexelTable MakeLinearTable(int most) {
  return MakeTable(most + 1, [&](int code) { return static_cast<double>(code) / most; });
}

// Encodes each value as the code code_of(value) of the table. Returns nothing unless the table has
// every value bit for bit.
template <typename Code, class CodeOf>
std::optional<Texels> Encode(std::span<const float> values, const TexelTable& table,
                             const CodeOf& code_of) {
  Texels texels(table, values.size());
  for (size_t i = 0; i < values.size(); ++i) {
    const auto code = static_cast<Code>(code_of(values[i]));
    if (std::bit_cast<uint32_t>((*table)[code]) != std::bit_cast<uint32_t>(values[i])) return {};
    texels.As<Code>()[i] = code;
  }
  return texels;
}

}  // namespace

void TexelView::Read(size_t first, std::span<float> to) const {
  const auto read = [&](const auto* codes) {
    for (size_t i = 0; i < to.size(); ++i) to[i] = table[codes[first + i]];
  };
  if (kind == TexelKind::kBytes) {
    read(static_cast<const uint8_t*>(data));
  } else if (kind == TexelKind::kWords) {
    read(static_cast<const uint16_t*>(data));
  } else {
    std::copy_n(static_cast<const float*>(data) + first, to.size(), to.begin());
  }
}

Texels::Texels(TexelTable codes, size_t count) : table(std::move(codes)) {
  constexpr size_t kBytesOfValue[] = {sizeof(float), sizeof(uint8_t), sizeof(uint16_t)};
  constexpr size_t kReadBeyond = sizeof(uint32_t) - sizeof(uint8_t);  // the kernels read 32 bits
  data.resize(count * kBytesOfValue[static_cast<size_t>(kind())] + kReadBeyond);
}

Texels PackTexels(std::span<const float> values) {
  static const TexelTable bytes = MakeLinearTable(255), words = MakeLinearTable(65535);
  static const TexelTable halves =
      MakeTable(1 << 16, [](int code) { return imath_half_to_float(static_cast<uint16_t>(code)); });
  const auto nearest = [](float most) {
    return [most](float value) {
      return value >= 0 && value <= 1 ? static_cast<uint16_t>(value * most + 0.5f) : uint16_t{0};
    };
  };
  if (auto texels = Encode<uint8_t>(values, bytes, nearest(255))) return *std::move(texels);
  if (auto texels = Encode<uint16_t>(values, words, nearest(65535))) return *std::move(texels);
  if (auto texels = Encode<uint16_t>(values, halves, imath_float_to_half)) {
    return *std::move(texels);
  }
  Texels texels(nullptr, values.size());
  std::copy(values.begin(), values.end(), texels.As<float>());
  return texels;
}

MipChain::MipChain(int width, int height, int channels_of_image, Texels image)
    : channels(channels_of_image), image_(std::move(image)) {
  for (int w = width, h = height;; w = std::max(w / 2, 1), h = std::max(h / 2, 1)) {
    levels.push_back({w, h});
    if (w == 1 && h == 1) break;
  }
  smaller_ = std::make_unique<SmallerLevels>(levels.size());
  whole_ = {image_.kind(),
            image_.data.data(),
            image_.table ? image_.table->data() : nullptr,
            channels,
            width,
            height};
  least = greatest = whole_[0];
  const auto widen = [&](float value) {
    least = std::min(least, value);
    greatest = std::max(greatest, value);
  };
  if (whole_.kind == TexelKind::kFloats) {
    std::for_each_n(image_.As<const float>(), whole_.size(), widen);
    return;
  }
  std::vector<uint8_t> occurs(image_.table->size());
  const auto mark = [&](size_t code) { occurs[code] = 1; };
  if (whole_.kind == TexelKind::kBytes) {
    std::for_each_n(image_.As<const uint8_t>(), whole_.size(), mark);
  } else {
    std::for_each_n(image_.As<const uint16_t>(), whole_.size(), mark);
  }
  for (size_t code = 0; code < occurs.size(); ++code) {
    if (occurs[code] != 0) widen(whole_.table[code]);
  }
}

size_t MipChain::LevelBytes() const {
  size_t bytes = 0;
  for (size_t level = 1; level < levels.size(); ++level) {
    if (smaller_->made[level]) bytes += FloatLevel(level, nullptr).size() * sizeof(float);
  }
  return bytes;
}

const float* MipChain::MakeLevel(size_t level) const {
  const std::lock_guard lock(smaller_->making);
  const DefaultFloatMode keeps_denormals;
  size_t from = level;  // becomes the nearest larger level that has been made
  while (from > 0 && smaller_->made[from] == nullptr) --from;
  if (from == level) return smaller_->made[level];  // made by another thread meanwhile
  TexelView larger = Level(from);
  HugeVector<float> values;
  for (size_t l = from + 1; l <= level; ++l) {
    values = MakeNextLevel(larger, levels[l]);
    larger = FloatLevel(l, values.data());
  }
  smaller_->values[level] = std::move(values);
  smaller_->made[level].store(smaller_->values[level].data(), std::memory_order_release);
  return smaller_->made[level];
}

MipChain MakeMipChain(int width, int height, int channels, const std::vector<float>& image) {
  return {width, height, channels, PackTexels(image)};
}

}  // namespace nacre
