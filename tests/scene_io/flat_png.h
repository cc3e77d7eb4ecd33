// SPDX-License-Identifier: Apache-2.0
// tests/scene_io/flat_png.h: two small files of large pictures, for bounds that go by file size.
#pragma once

#include <string>

namespace nacre {

// 256 x 256 black pixels: 196 608 values in 270 bytes.
inline std::string FlatPng() {
  constexpr unsigned char kBytes[] = {
      137, 80,  78,  71,  13,  10, 26,  10, 0,   0,   0,   13,  73,  72, 68,  82,  0,   0,   1,  0,
      0,   0,   1,   0,   8,   2,  0,   0,  0,   211, 16,  63,  49,  0,  0,   0,   213, 73,  68, 65,
      84,  120, 218, 237, 193, 49, 1,   0,  0,   0,   194, 160, 245, 79, 237, 101, 11,  160, 0,  0,
      0,   0,   0,   0,   0,   0,  0,   0,  0,   0,   0,   0,   0,   0,  0,   0,   0,   0,   0,  0,
      0,   0,   0,   0,   0,   0,  0,   0,  0,   0,   0,   0,   0,   0,  0,   0,   0,   0,   0,  0,
      0,   0,   0,   0,   0,   0,  0,   0,  0,   0,   0,   0,   0,   0,  0,   0,   0,   0,   0,  0,
      0,   0,   0,   0,   0,   0,  0,   0,  0,   0,   0,   0,   0,   0,  0,   0,   0,   0,   0,  0,
      0,   0,   0,   0,   0,   0,  0,   0,  0,   0,   0,   0,   0,   0,  0,   0,   0,   0,   0,  0,
      0,   0,   0,   0,   0,   0,  0,   0,  0,   0,   0,   0,   0,   0,  0,   0,   0,   0,   0,  0,
      0,   0,   0,   0,   0,   0,  0,   0,  0,   0,   0,   0,   0,   0,  0,   0,   0,   0,   0,  0,
      0,   0,   0,   0,   0,   0,  0,   0,  0,   0,   0,   0,   0,   0,  0,   0,   0,   0,   0,  0,
      0,   0,   0,   0,   0,   0,  0,   0,  0,   0,   0,   0,   0,   0,  0,   0,   0,   0,   0,  0,
      0,   0,   0,   0,   0,   0,  0,   0,  128, 27,  1,   45,  0,   1,  158, 203, 194, 237, 0,  0,
      0,   0,   73,  69,  78,  68, 174, 66, 96,  130};
  return {reinterpret_cast<const char*>(kBytes), sizeof(kBytes)};
}

// A header that promises 16384 x 2730 pixels: 2^27 - 32 768 values. Most of its rows are missing,
// so that whoever decodes it before looking at its size says something else of it.
inline std::string LargePng() {
  constexpr unsigned char kBytes[] = {
      137, 80,  78,  71, 13, 10,  26,  10, 0,  0,   0,  13,  73, 72,  68,  82, 0, 0,
      64,  0,   0,   0,  10, 170, 8,   2,  0,  0,   0,  126, 86, 159, 108, 0,  0, 0,
      12,  73,  68,  65, 84, 120, 218, 99, 96, 160, 61, 0,   0,  0,   100, 0,  1, 184,
      153, 239, 153, 0,  0,  0,   0,   73, 69, 78,  68, 174, 66, 96,  130};
  return {reinterpret_cast<const char*>(kBytes), sizeof(kBytes)};
}

}  // namespace nacre
