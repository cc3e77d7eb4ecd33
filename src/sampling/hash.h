// SPDX-License-Identifier: Apache-2.0
// sampling/hash.h: integer hashes for seeding sample patterns. Not cryptographic.
#pragma once

#include <cstdint>

namespace nacre {

// A bijection in which every input bit flips every output bit about half the time: David
// Stafford's variant 13 of MurmurHash3's finaliser (2011), as in SplitMix64 (Steele et al. 2014).
constexpr uint64_t Mix64(uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

// A hash of two integers in order: HashCombine(a, b) and HashCombine(b, a) are unrelated.
constexpr uint64_t MixFirst(uint64_t a) {
  return Mix64(a + 0x9e3779b97f4a7c15u);  // the offset keeps (0, 0) from giving 0
}
constexpr uint64_t HashCombine(uint64_t a, uint64_t b) { return Mix64(MixFirst(a) ^ b); }

// The seed of a pixel, which depends on nothing but its absolute coordinates and the user's seed,
// so that crops and tiles of an image have the samples of the whole image.
constexpr uint64_t PixelSeed(int x, int y, uint32_t seed) {
  const uint64_t pixel =
      static_cast<uint64_t>(static_cast<uint32_t>(y)) << 32 | static_cast<uint32_t>(x);
  return HashCombine(seed, pixel);
}

}  // namespace nacre
