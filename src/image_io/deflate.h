// SPDX-License-Identifier: Apache-2.0
// image_io/deflate.h: deflate, by ISA-L where speed matters and by zlib where size does.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace nacre {

enum class DeflateForm {
  kZlib,      // a complete zlib stream
  kPart,      // raw deflate that ends on a byte boundary, so that another part can follow
  kLastPart,  // raw deflate that ends the stream
};

// Level 1 is ISA-L's: several times as fast as zlib's fastest, at 12 to 25 % more bytes. On
// AVX-512, its output is not reproducible: one process in some thousands writes other bytes for the
// same input (ISA-L 2.30), which inflate to the same. Levels 2 to 9 are zlib's and are
// reproducible.
inline constexpr int kFastDeflate = 1;
inline constexpr int kReproducibleDeflate = 2;

// Compresses at most 2^31 bytes. Parts do not refer to earlier ones, so that threads can make them
// in parallel.
std::vector<uint8_t> Deflate(std::span<const uint8_t> bytes, DeflateForm form, int level);

}  // namespace nacre
