// SPDX-License-Identifier: Apache-2.0
// api/shown.h: which values of an image of the public API a display shows, and how.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "api/border.h"
#include "color/display.h"

namespace nacre::v0 {

struct Shown {
  // Throws Error (kUsage) for settings out of range, and where `what` finds no such layer.
  Shown(const Image& image, const ToneMapSettings& settings, const std::string& what);

  nacre::DisplaySettings display;
  bool displayed;  // the values are a display's already
  std::array<const float*, 3> rgb;

 private:
  std::array<std::vector<float>, 3> converted_;  // to Rec. 709, if the image has other primaries
};

// The codes of pixels from `first` on, row by row: R, G and B of each.
void EncodePixels(const Shown& shown, size_t first, size_t count, uint8_t* rgb8);

}  // namespace nacre::v0
