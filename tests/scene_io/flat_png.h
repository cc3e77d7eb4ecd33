// SPDX-License-Identifier: Apache-2.0
// tests/scene_io/flat_png.h: small files of large pictures, for bounds that go by file size.
#pragma once

#include <string>
#include <vector>

#include "image_io/png_bytes.h"

namespace nacre {

// Black pixels, a bit each in the file and a value each once they are read: a thousand of them and
// more for each of its bytes.
inline std::string BlackPng(uint32_t width, uint32_t height) {
  std::vector<uint8_t> file = PngHead(width, height, 1, 0);
  AppendPixels(std::vector<uint8_t>(size_t{height} * (width / 8 + 1)), &file);
  return {file.begin(), file.end()};
}

// 2^23 values, of which 16 are 2^27.
inline std::string FlatPng() { return BlackPng(4096, 2048); }

// 2^27 values but for 2^22: with FlatPng's more than any file of its size may have.
inline std::string LargePng() { return BlackPng(16384, 7936); }

}  // namespace nacre
