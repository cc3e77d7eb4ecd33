// SPDX-License-Identifier: Apache-2.0
// image_io/icc_profile.h: whether an ICC profile is sRGB's.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace nacre {

// What is said of an image's colours in its metadata, of a profile that is embedded in its file.
struct IccProfile {
  std::string name;  // "sRGB", or how the profile calls itself
  bool is_srgb = false;
};

// By what the profile makes of colours, not by its name: there are hundreds of sRGB profiles, and
// "Linear sRGB" is none. Of a grey one its curve counts.
IccProfile ReadIccProfile(std::span<const uint8_t> profile);

}  // namespace nacre
