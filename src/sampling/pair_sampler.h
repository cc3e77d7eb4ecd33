// SPDX-License-Identifier: Apache-2.0
// sampling/pair_sampler.h: the 2-D points that a sample needs besides its film position: on lights
// and in lobes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/aligned.h"

namespace nacre {

// Each pair of dimensions is a (0,2)-sequence of its own, scrambled and shuffled independently
// (padding), so that the few samples of a pixel are well distributed in each pair. Pairs of higher
// dimensions of the pixel sampler's sequence would be well distributed for many samples only. As in
// the pixel sampler, each pixel shifts the points' binary digits by random numbers of its own.
struct PairSampler {
  size_t samples = 0;                    // per pixel
  std::vector<uint32_t> u_bits, v_bits;  // entry pair * samples + i is the point of sample i
};

// `samples` is the number of samples per pixel, in [1, 65536].
PairSampler MakePairSampler(int samples, size_t pairs, uint32_t seed);

// Identifies the sample of each entry: its index among the samples of its pixel, and the index of
// the pixel in `seeds`, which holds the pixels' PixelSeeds.
struct SampleNumbers {
  explicit SampleNumbers(size_t capacity) : number(capacity), pixel(capacity), seeds(capacity) {}
  AlignedArray<uint32_t> number, pixel;
  size_t pixel_count = 0;
  AlignedArray<uint64_t> seeds;
};

// Points in [0, 1)^2, as 32-bit binary fractions, and as floats, which keep the upper 24 bits.
struct UnitPoints {
  explicit UnitPoints(size_t capacity)
      : u_bits(capacity), v_bits(capacity), u(capacity), v(capacity), shifts(capacity) {}
  AlignedArray<uint32_t> u_bits, v_bits;
  AlignedArray<float> u, v;
  AlignedArray<uint64_t> shifts;  // per pixel: low half for u, high half for v
};

// Stores in points[0..count) the points of a pair for the samples entries[0..count).
void SamplePair(const PairSampler& sampler, size_t pair, const SampleNumbers& samples,
                const uint32_t* entries, size_t count, UnitPoints* points);

}  // namespace nacre
