// SPDX-License-Identifier: Apache-2.0
// image_io/exr_chunk.h: one chunk of an EXR file, compressed. Any thread.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "image_io/exr_compression.h"
#include "image_io/exr_rows.h"

namespace nacre {

// ZIP and ZIPS: split, predicted and deflated; or the bytes as they are where that is not shorter.
std::vector<uint8_t> CompressZip(std::span<const uint16_t> words, int deflate_level);

// By OpenEXR itself, for compressions that are not only deflate: `words` are whole rows.
std::vector<uint8_t> CompressByLibrary(const ExrLayout& layout, Compression compression,
                                       std::span<const uint16_t> words);

}  // namespace nacre
