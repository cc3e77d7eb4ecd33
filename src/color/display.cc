// SPDX-License-Identifier: Apache-2.0
#include "color/display.h"

namespace nacre {

Rgb8Picture ShowImage(const Image& image, const DisplaySettings& settings,
                      const std::string& layer) {
  const std::string prefix = layer.empty() ? "" : layer + ".";
  const auto plane = [&](const char* channel) {
    return image.Find(prefix + channel)->samples.data();
  };
  Rgb8Picture picture{image.data.width(), image.data.height(), {}};
  picture.rgb8.resize(3 * image.data.pixel_count());
  EncodeDisplay(settings, plane("R"), plane("G"), plane("B"), image.data.pixel_count(),
                picture.rgb8.data());
  return picture;
}

}  // namespace nacre
