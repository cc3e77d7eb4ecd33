// SPDX-License-Identifier: Apache-2.0
// image_io/exif.h: reads the orientation from an EXIF block.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace nacre {

// The orientation tag (0x0112) of the first directory of an EXIF block, which begins like a TIFF
// file; 1, the usual one, if there is none or the block is broken. orientation.h interprets the
// numbers. This is written by hand because libexif would decode every tag of every maker to return
// this one.
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

}  // namespace nacre
