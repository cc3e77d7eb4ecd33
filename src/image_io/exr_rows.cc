// SPDX-License-Identifier: Apache-2.0
#include "image_io/exr_rows.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <numeric>

#include "base/error.h"

namespace nacre {
namespace {

static_assert(std::endian::native == std::endian::little, "EXR files are little-endian");

// Rows of the largest chunks (PIZ, DWAA). The format stores the size of a chunk in 31 bits.
constexpr size_t kMaxChunkRows = 32;

uint32_t ToId(float value) {
  constexpr float kTooLarge = 4294967296.0f;
  if (!(value > 0)) return 0;
  return value < kTooLarge ? static_cast<uint32_t>(value) : std::numeric_limits<uint32_t>::max();
}

// Converts one row of one channel.
SampleCounts PackRow(PixelType type, const float* in, size_t width, uint16_t* words) {
  switch (type) {
    case PixelType::kHalf:
      return FloatToHalf(in, width, words);
    case PixelType::kFloat:
      std::memcpy(words, in, width * sizeof(float));
      return CountNonfinite(in, width);
    case PixelType::kUint:
      for (size_t x = 0; x < width; ++x) {
        const uint32_t id = ToId(in[x]);
        std::memcpy(words + 2 * x, &id, sizeof(id));
      }
      return {};
  }
  return {};
}

SampleCounts PackRow(PixelType type, const uint32_t* in, size_t width, uint16_t* words) {
  if (type != PixelType::kUint) {
    throw Error(ExitCode::kInternal, "", "ids given for a channel of real numbers");
  }
  std::memcpy(words, in, width * sizeof(uint32_t));
  return {};
}

}  // namespace

size_t SampleWords(PixelType type) { return type == PixelType::kHalf ? 1 : 2; }

ExrLayout MakeExrLayout(const std::string& path, const ExrHeader& header) {
  ExrLayout layout;
  layout.width = static_cast<size_t>(header.data.width());
  layout.source.resize(header.channels.size());
  std::iota(layout.source.begin(), layout.source.end(), size_t{0});
  const auto name = [&](size_t i) -> const std::string& { return header.channels[i].name; };
  std::ranges::sort(layout.source, {}, name);
  if (layout.source.empty() || name(layout.source.front()).empty()) {
    throw Error(ExitCode::kInternal, path, "a picture needs channels, and they need names");
  }
  const auto twin = std::ranges::adjacent_find(layout.source, {}, name);
  if (twin != layout.source.end()) {
    throw Error(ExitCode::kInternal, path, "two channels are called " + name(*twin));
  }
  for (const size_t i : layout.source) {
    layout.channels.push_back(header.channels[i]);
    layout.row_words += layout.width * SampleWords(header.channels[i].type);
  }
  if (layout.row_words > std::numeric_limits<int32_t>::max() / (2 * kMaxChunkRows)) {
    throw Error(ExitCode::kInternal, path, "rows are too long for EXR",
                "ask for fewer layers or a smaller picture");
  }
  return layout;
}

SampleCounts PackRows(const ExrLayout& layout, const StripView& strip, uint16_t* words) {
  SampleCounts counts;
  uint16_t* channel_words = words;
  for (size_t c = 0; c < layout.channels.size(); ++c) {
    const PixelType type = layout.channels[c].type;
    std::visit(
        [&](const auto* samples) {
          for (size_t row = 0; row < static_cast<size_t>(strip.rows); ++row) {
            counts += PackRow(type, samples + row * layout.width, layout.width,
                              channel_words + row * layout.row_words);
          }
        },
        strip.channels[layout.source[c]]);
    channel_words += layout.width * SampleWords(type);
  }
  return counts;
}

}  // namespace nacre
