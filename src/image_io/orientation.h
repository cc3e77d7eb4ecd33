// SPDX-License-Identifier: Apache-2.0
// image_io/orientation.h: how the rows of a file lie in the displayed image, for Radiance's
// resolution strings and for the orientation tags of TIFF and EXIF.
#pragma once

#include <algorithm>
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
  switch (tag) {
    case 2:
      return {false, true, false};
    case 3:
      return {false, true, true};
    case 4:
      return {false, false, true};
    case 5:
      return {true, false, false};
    case 6:
      return {true, true, false};
    case 7:
      return {true, true, true};
    case 8:
      return {true, false, true};
    default:
      return {};
  }
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

  // `row` is a stored row with interleaved channels.
  void Place(int stored_y, const float* row, size_t channels) const {
    if (orientation_ == Orientation()) return PlaceAsStored(stored_y, row, channels);
    for (const SampleTarget& target : targets_) {
      for (int x = 0; x < stored_width(); ++x) {
        int seen_x = orientation_.transpose ? stored_y : x;
        int seen_y = orientation_.transpose ? x : stored_y;
        if (orientation_.flip_x) seen_x = data_.width() - 1 - seen_x;
        if (orientation_.flip_y) seen_y = data_.height() - 1 - seen_y;
        seen_x += data_.x0 - region_.x0;
        seen_y += data_.y0 - region_.y0;
        if (seen_x < 0 || seen_x >= region_.width() || seen_y < 0 || seen_y >= region_.height()) {
          continue;
        }
        target.first[seen_x * target.step_x + seen_y * target.step_y] =
            row[static_cast<size_t>(x) * channels + target.channel];
      }
    }
  }

 private:
  // For images that are displayed as stored.
  void PlaceAsStored(int stored_y, const float* row, size_t channels) const {
    const int y = stored_y + data_.y0 - region_.y0;
    if (y < 0 || y >= region_.height()) return;
    const int first = std::max(region_.x0 - data_.x0, 0);
    const int end = std::min(region_.x1 - data_.x0, data_.width());
    for (const SampleTarget& target : targets_) {
      float* out =
          target.first + (first + data_.x0 - region_.x0) * target.step_x + y * target.step_y;
      for (int x = first; x < end; ++x, out += target.step_x) {
        *out = row[static_cast<size_t>(x) * channels + target.channel];
      }
    }
  }

  Orientation orientation_;
  Window data_, region_;
  std::span<const SampleTarget> targets_;
};

}  // namespace nacre
