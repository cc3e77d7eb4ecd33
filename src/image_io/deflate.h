// SPDX-License-Identifier: Apache-2.0
// image_io/deflate.h: deflate, by ISA-L where speed counts and by zlib where size does.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace nacre {

enum class DeflateForm {
  kZlib,      // a complete zlib stream
  kPart,      // raw deflate that ends on a byte, for another part to follow
  kLastPart,  // raw deflate that ends the stream
};

// Level 1 is ISA-L's: several times as fast as zlib's fastest, at 12 to 25 % more bytes. On
// AVX-512, one process in some thousands makes other bytes of the same input (ISA-L 2.30), which
// inflate to the same. 2 .. 9 are zlib's: always the same bytes.
inline constexpr int kFastDeflate = 1;
inline constexpr int kReproducibleDeflate = 2;

// At most 2^31 bytes. Parts refer to nothing before them, so several threads may each make one.
std::vector<uint8_t> Deflate(std::span<const uint8_t> bytes, DeflateForm form, int level);

}  // namespace nacre
