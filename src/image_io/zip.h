// SPDX-License-Identifier: Apache-2.0
// image_io/zip.h: the transformation of samples before deflate in EXR's ZIP compressions.
#pragma once

#include <cstddef>
#include <cstdint>

namespace nacre {

// Reorders the bytes of `words` (little-endian), the even ones first, then the odd ones. Then
// writes the first byte and, for every other, its difference from the one before plus 128, modulo
// 256. `bytes` has room for 2 * count.
void SplitAndPredict(const uint16_t* words, size_t count, uint8_t* bytes);

}  // namespace nacre
