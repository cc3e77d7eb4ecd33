// SPDX-License-Identifier: Apache-2.0
// api/shown.h: selects the values of a public image that a display shows, and encodes them.
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
  // Throws Error (kUsage) for settings out of range, and if there is no such layer; `what` names
  // the function in errors.
  Shown(const Image& image, const ToneMapSettings& settings, const std::string& what);

  nacre::DisplaySettings display;
  bool displayed;  // the values are display values already
  std::array<const float*, 3> rgb;

 private:
  std::array<std::vector<float>, 3> converted_;  // in Rec. 709, if the image has other primaries
};

// Writes the codes of `count` pixels, row by row from pixel `first` on: R, G and B of each.
void EncodePixels(const Shown& shown, size_t first, size_t count, uint8_t* rgb8);

}  // namespace nacre::v0
