// SPDX-License-Identifier: Apache-2.0
// image_io/exr_chunk.h: compresses one chunk of an EXR file. May be called from any thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "image_io/exr_compression.h"
#include "image_io/exr_rows.h"

namespace nacre {

// Without compression: the bytes as they are.
std::vector<uint8_t> StoreWords(std::span<const uint16_t> words);

// ZIP and ZIPS: splits, predicts and deflates; or returns the bytes unchanged if that is not
// shorter.
std::vector<uint8_t> CompressZip(std::span<const uint16_t> words, int deflate_level);

// What CompressZip does before it deflates. Reorders the bytes of `words` (little-endian), the even
// ones first, then the odd ones. Then writes the first byte and, for every other, its difference
// from the one before plus 128, modulo 256. `bytes` has room for 2 * count.
void SplitAndPredict(const uint16_t* words, size_t count, uint8_t* bytes);

// Compresses by OpenEXR, for PIZ and DWAA. `words` are whole rows.
std::vector<uint8_t> CompressByLibrary(const ExrLayout& layout, Compression compression,
                                       std::span<const uint16_t> words);

}  // namespace nacre
