// SPDX-License-Identifier: Apache-2.0
// image_io/orientation.h: how the rows of a file lie in the displayed image, for Radiance's
// resolution strings and for the orientation tags of TIFF and EXIF.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "image_io/image_file.h"

namespace nacre {

// How stored rows become the displayed image: first they are transposed, then mirrored.
struct Orientation {
  bool transpose = false;
  bool flip_x = false, flip_y = false;

  bool operator==(const Orientation&) const = default;
};

// Tags 1 to 8 of TIFF 6.0, "Orientation", and EXIF. They say where the stored row 0 and column 0
// are displayed: top left, top right, bottom right, bottom left; left top, right top, right bottom,
// left bottom. Any other number counts as 1.
constexpr Orientation OrientationOfTag(int tag) {
  constexpr std::array<Orientation, 9> kOfTag = {{{},
                                                  {},
                                                  {false, true, false},
                                                  {false, true, true},
                                                  {false, false, true},
                                                  {true, false, false},
                                                  {true, true, false},
                                                  {true, true, true},
                                                  {true, false, true}}};
  return kOfTag[tag >= 1 && tag <= 8 ? static_cast<size_t>(tag) : 0];
}

// The orientation tag (0x0112) of the first directory of an EXIF block, which begins like a TIFF
// file; 1, the usual one, if there is none or the block is broken. It is read by hand because
// libexif would decode every tag of every maker to return this one.
inline int ExifOrientation(std::span<const uint8_t> exif) {
  if (exif.size() < 8) return 1;
  const bool little = exif[0] == 'I';
  const auto number = [&](size_t at, size_t bytes) {
    size_t value = 0;
    for (size_t i = 0; i < bytes && at + bytes <= exif.size(); ++i) {
      value |= size_t{exif[at + i]} << 8 * (little ? i : bytes - 1 - i);
    }
    return value;
  };
  constexpr size_t kOrientation = 0x0112, kEntry = 12;
  const size_t first = number(4, 4);
  const size_t entries = number(first, 2);
  for (size_t i = 0; i < entries && first + 2 + (i + 1) * kEntry <= exif.size(); ++i) {
    const size_t at = first + 2 + i * kEntry;
    if (number(at, 2) == kOrientation) return static_cast<int>(number(at + 8, 2));
  }
  return 1;
}

// Writes stored rows to their place in the displayed image.
class RowPlacer {
 public:
  // `data` is the window of the displayed image, and `region` the part of it that is wanted.
  RowPlacer(const Orientation& orientation, const Window& data, const Window& region,
            std::span<const SampleTarget> targets)
      : orientation_(orientation), data_(data), region_(region), targets_(targets) {}

  int stored_width() const { return orientation_.transpose ? data_.height() : data_.width(); }
  int stored_height() const { return orientation_.transpose ? data_.width() : data_.height(); }

  // `row` is a stored row with interleaved channels. It lies along one axis of the displayed image.
  void Place(int stored_y, const float* row, size_t channels) const {
    const auto [transpose, flip_x, flip_y] = orientation_;
    const int left = data_.x0 - region_.x0, top = data_.y0 - region_.y0;
    const bool is_last_first = transpose ? flip_x : flip_y;  // of the rows
    const int across =
        (is_last_first ? stored_height() - 1 - stored_y : stored_y) + (transpose ? left : top);
    if (across < 0 || across >= (transpose ? region_.width() : region_.height())) return;
    const bool is_mirrored = transpose ? flip_y : flip_x;
    const int begin = transpose ? top : left, width = stored_width();
    const int first = std::max(begin, 0);
    const int end = std::min(begin + width, transpose ? region_.height() : region_.width());
    for (const SampleTarget& target : targets_) {
      const ptrdiff_t step = transpose ? target.step_y : target.step_x;
      float* out = target.first + across * (transpose ? target.step_x : target.step_y);
      for (int along = first; along < end; ++along) {
        const int x = is_mirrored ? begin + width - 1 - along : along - begin;
        out[along * step] = row[static_cast<size_t>(x) * channels + target.channel];
      }
    }
  }

 private:
  Orientation orientation_;
  Window data_, region_;
  std::span<const SampleTarget> targets_;
};

}  // namespace nacre
