// SPDX-License-Identifier: Apache-2.0
// image_io/zip.h: what EXR's ZIP compressions do to samples before they deflate them.
#pragma once

#include <cstddef>
#include <cstdint>

namespace nacre {

// Puts the even bytes of `words` (little-endian) first and the odd ones after them, then writes
// the first byte and of every other its difference from the one before plus 128, modulo 256.
// `bytes` holds 2 * count.
void SplitAndPredict(const uint16_t* words, size_t count, uint8_t* bytes);

}  // namespace nacre
