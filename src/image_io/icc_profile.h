// SPDX-License-Identifier: Apache-2.0
// image_io/icc_profile.h: whether an ICC profile describes sRGB.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>

namespace nacre {

// What the metadata of an image says about the profile that is embedded in its file.
struct IccProfile {
  std::string name;  // "sRGB", or the profile's description
  bool is_srgb = false;
};

// Judges a profile by what it does to colours, not by its name: there are hundreds of sRGB
// profiles, and "Linear sRGB" is none of them. A grey profile is judged by its curve.
IccProfile ReadIccProfile(std::span<const uint8_t> profile);

// Sets "icc_profile", the name, and "not_srgb", why the image is none in words, or removes the
// latter.
void NoteIccProfile(std::span<const uint8_t> profile, std::map<std::string, std::string>* metadata);

}  // namespace nacre
