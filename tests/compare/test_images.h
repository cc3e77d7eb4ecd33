// SPDX-License-Identifier: Apache-2.0
// tests/compare/test_images.h: small images for the tests of compare.
#pragma once

#include <string>
#include <vector>

#include "base/image.h"

namespace nacre {

// An image whose display and data windows are `window`, all samples `value`.
inline Image MakeImage(const Window& window, const std::vector<std::string>& channels,
                       float value) {
  Image image;
  image.display = image.data = window;
  for (const std::string& name : channels) {
    image.channels.push_back(
        {name, PixelType::kFloat, std::vector<float>(window.pixel_count(), value)});
  }
  return image;
}

// The sample of a channel at frame coordinates.
inline float& SampleAt(Image& image, const std::string& channel, int x, int y) {
  for (Channel& candidate : image.channels) {
    if (candidate.name != channel) continue;
    const auto row = static_cast<size_t>(y - image.data.y0);
    const auto column = static_cast<size_t>(x - image.data.x0);
    return candidate.samples[row * static_cast<size_t>(image.data.width()) + column];
  }
  throw channel;
}

}  // namespace nacre
