// SPDX-License-Identifier: Apache-2.0
// texture/texels.h: a decoded image that textures sample: linear values, with a mip chain.
//
// The image itself stays as small as its file had it: codes of 8 or 16 bits, which a table decodes
// to floats when they are looked up, or floats. Mip levels are floats, because filtering is done in
// linear light: a filtered level of 8-bit sRGB codes needs more than 8 bits. They are made when a
// look-up first needs them: most images are seen at two or three of their levels.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "base/huge_pages.h"

namespace nacre {

enum class TexelKind : uint8_t { kFloats, kBytes, kWords };

// The texels of a level: row by row, row 0 at v = 0 (the bottom of a picture), with interleaved
// channels.
struct TexelView {
  TexelKind kind = TexelKind::kFloats;
  const void* data = nullptr;
  const float* table = nullptr;  // the value of each code, if `data` holds codes
  int channels = 1, width = 0, height = 0;

  size_t size() const {
    return static_cast<size_t>(width) * static_cast<size_t>(height) * static_cast<size_t>(channels);
  }
  float operator[](size_t i) const {
    if (kind == TexelKind::kBytes) return table[static_cast<const uint8_t*>(data)[i]];
    if (kind == TexelKind::kWords) return table[static_cast<const uint16_t*>(data)[i]];
    return static_cast<const float*>(data)[i];
  }
  float At(int x, int y, int channel) const {
    return (*this)[(static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)) *
                       static_cast<size_t>(channels) +
                   static_cast<size_t>(channel)];
  }
  // Decodes the values from index `first` on.
  void Read(size_t first, std::span<float> to) const;
};

// The values of all codes: 256 or 65536 floats.
using TexelTable = std::shared_ptr<const std::vector<float>>;

// The values of an image as they are stored.
struct Texels {
  TexelTable table;  // null if the values are floats
  HugeVector<std::byte> data;

  // Makes room for `count` values, which the caller writes.
  Texels(TexelTable codes, size_t count);
  TexelKind kind() const {
    if (table == nullptr) return TexelKind::kFloats;
    return table->size() == 256 ? TexelKind::kBytes : TexelKind::kWords;
  }
  template <typename T>
  T* As() {
    return reinterpret_cast<T*>(data.data());
  }
};

// Stores the values in the smallest form that holds each bit for bit: as codes k / 255 or
// k / 65535, as halves, or as floats.
Texels PackTexels(std::span<const float> values);

// A mip level.
struct MipLevel {
  int32_t width, height;
};

class MipChain {
 public:
  MipChain(int width, int height, int channels, Texels image);

  int channels;                  // 1 to 4
  std::vector<MipLevel> levels;  // the image itself, then half its size (rounded down) each time
  float least, greatest;         // of the image's values

  // Makes the level if it is needed for the first time. Several threads may call it at once.
  TexelView Level(size_t level) const {
    if (level == 0) return whole_;
    const float* const values = smaller_->made[level].load(std::memory_order_acquire);
    return FloatLevel(level, values != nullptr ? values : MakeLevel(level));
  }
  float Value(size_t level, int x, int y, int channel) const {
    return Level(level).At(x, y, channel);
  }

  // The memory of the image, and of the smaller levels that have been made.
  size_t ImageBytes() const { return image_.data.size(); }
  size_t LevelBytes() const;

 private:
  // The levels from 1 on.
  struct SmallerLevels {
    explicit SmallerLevels(size_t count) : values(count), made(count) {}
    std::mutex making;
    std::vector<HugeVector<float>> values;
    std::vector<std::atomic<const float*>> made;  // null until the level is made
  };

  TexelView FloatLevel(size_t level, const float* values) const {
    const MipLevel& l = levels[level];
    return {TexelKind::kFloats, values, nullptr, channels, l.width, l.height};
  }
  const float* MakeLevel(size_t level) const;

  Texels image_;
  TexelView whole_;  // a view of image_
  std::unique_ptr<SmallerLevels> smaller_;
};

// The maximum number of values of an image, so that their byte offsets fit 32 bits.
inline constexpr size_t kMaxTexelValues = size_t{1} << 30;

// The image with all levels down to 1x1. Each texel of a level is the mean, computed in double, of
// the rectangle that it covers in the level above, with partly covered texels weighted by area:
// images of any size keep their mean. `image` holds width x height x channels values.
MipChain MakeMipChain(int width, int height, int channels, const std::vector<float>& image);

}  // namespace nacre
