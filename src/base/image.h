// SPDX-License-Identifier: Apache-2.0
// base/image.h: an image in memory: named float channels and the windows they cover. Readers return
// it, comparisons work on it and tests build it. Rendering works strip by strip and never holds
// one.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace nacre {

// A rectangle of pixels: x0 <= x < x1, y0 <= y < y1, y downwards.
struct Window {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;

  int width() const { return x1 - x0; }
  int height() const { return y1 - y0; }
  size_t pixel_count() const {
    return static_cast<size_t>(width()) * static_cast<size_t>(height());
  }
  bool empty() const { return width() <= 0 || height() <= 0; }
  bool operator==(const Window&) const = default;
};

// The index of a pixel in a window, row by row.
inline size_t IndexIn(const Window& window, int x, int y) {
  return static_cast<size_t>(y - window.y0) * static_cast<size_t>(window.width()) +
         static_cast<size_t>(x - window.x0);
}

inline Window Intersect(const Window& a, const Window& b) {
  return {std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)};
}

// The smallest window that contains both windows, neither of which is empty.
inline Window BoundingWindow(const Window& a, const Window& b) {
  return {std::min(a.x0, b.x0), std::min(a.y0, b.y0), std::max(a.x1, b.x1), std::max(a.y1, b.y1)};
}

// `count` pixels of row y, from column x on.
struct PixelRun {
  int x, y, count;
};

inline size_t CountPixels(std::span<const PixelRun> runs) {
  size_t pixels = 0;
  for (const PixelRun& run : runs) pixels += static_cast<size_t>(run.count);
  return pixels;
}

// How a channel's samples are stored in a file.
enum class PixelType : uint8_t { kHalf, kFloat, kUint };

struct Channel {
  std::string name;                    // EXR name: "R", "diffuse.G", "N.X", "id.object"
  PixelType type = PixelType::kFloat;  // in memory always float; uint ids are exact up to 2^24
  std::vector<float> samples;          // row by row over the data window
};

struct Image {
  Window display;  // the full frame
  Window data;     // the part that the channels cover
  std::vector<Channel> channels;
  std::map<std::string, std::string> metadata;  // header attributes as text

  // The channel with this name, or nullptr.
  const Channel* Find(std::string_view name) const {
    for (const Channel& channel : channels) {
      if (channel.name == name) return &channel;
    }
    return nullptr;
  }
};

}  // namespace nacre
