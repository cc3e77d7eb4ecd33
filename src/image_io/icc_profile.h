// SPDX-License-Identifier: Apache-2.0
// image_io/icc_profile.h: whether an ICC profile is sRGB's.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <string_view>

namespace nacre {

// By its description (ICC.1, "profileDescriptionTag"), which is ASCII or UTF-16: makers of profiles
// name the space, and there are hundreds of sRGB profiles that differ in their last digits.
inline bool IsSrgbProfile(std::span<const uint8_t> profile) {
  using std::string_view_literals::operator""sv;
  for (const std::string_view name :
       {"sRGB"sv, "s\0R\0G\0B"sv, "IEC61966-2.1"sv, "IEC61966-2-1"sv}) {
    const auto found = std::search(profile.begin(), profile.end(), name.begin(), name.end());
    if (found != profile.end()) return true;
  }
  return false;
}

}  // namespace nacre
