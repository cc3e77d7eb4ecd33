// SPDX-License-Identifier: Apache-2.0
// sampling/sobol.h: the Sobol' sequence with Owen's nested uniform scrambling.
//
// Scrambling preserves the (t,m,s)-nets of the sequence, makes estimates unbiased, and lowers the
// error of N samples of a smooth function from about N^-1 to N^-1.5 (Owen 1997).
#pragma once

#include <cstdint>

#include "base/vec.h"

namespace nacre {

// The number of dimensions of one sequence, and of pairs of dimensions.
inline constexpr uint32_t kSobolDimensions = 16;
inline constexpr uint32_t kSobolPairs = kSobolDimensions / 2;

// Point `index` of the unscrambled sequence in dimension < kSobolDimensions, as a 32-bit binary
// fraction. Dimensions 0 and 1 are a (0,2)-sequence.
uint32_t SobolBits(uint32_t index, uint32_t dimension);

// Owen's scrambling of 32 bits: each bit is flipped, or not, by a hash of the bits above it and
// the seed (Burley 2020, "Practical Hash-based Owen Scrambling").
uint32_t OwenScramble(uint32_t bits, uint32_t seed);

// The bits as a multiple of 2^-32 in [0, 1).
constexpr double UnitFromBits(uint32_t bits) { return bits * 0x1p-32; }

// Point `index` of a scrambled 2-D sequence: dimensions 2 pair and 2 pair + 1. kSobolPairs
// consecutive pairs are one jointly well-distributed sequence; the next ones are another, scrambled
// and shuffled independently. Every pair is well distributed by itself, and the first pair of each
// sequence is perfect: any 2^m points from a multiple of 2^m on are a (0,m,2)-net.
Vec2d SobolSample2D(uint32_t index, uint32_t pair, uint64_t seed);

}  // namespace nacre
