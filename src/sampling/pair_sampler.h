// SPDX-License-Identifier: Apache-2.0
// sampling/pair_sampler.h: the points that a sample takes besides its place in the pixel: on
// lights and in lobes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/aligned.h"

namespace nacre {

// Each pair is a (0,2)-sequence of its own, scrambled and shuffled independently, so that few
// samples of a pixel are well distributed over what each pair stands for: later dimensions of the
// sequence that places the sample in its pixel are so, by pairs, only when there are many more. As
// there each pixel shifts the digits by random numbers of its own.
struct PairSampler {
  size_t samples = 0;                    // a pixel
  std::vector<uint32_t> u_bits, v_bits;  // pair by pair, of each the points of all samples
};

// samples in [1, 65536].
PairSampler MakePairSampler(int samples, size_t pairs, uint32_t seed);

// Which sample each entry is: its number among its pixel's, and which of the pixels that is, whose
// PixelSeeds are `seeds`.
struct SampleNumbers {
  explicit SampleNumbers(size_t capacity) : number(capacity), pixel(capacity), seeds(capacity) {}
  AlignedArray<uint32_t> number, pixel;
  size_t pixel_count = 0;
  AlignedArray<uint64_t> seeds;
};

// Points in [0, 1)^2: 32 bits after the point, and as floats, which have 24.
struct UnitPoints {
  explicit UnitPoints(size_t capacity)
      : u_bits(capacity), v_bits(capacity), u(capacity), v(capacity), shifts(capacity) {}
  AlignedArray<uint32_t> u_bits, v_bits;
  AlignedArray<float> u, v;
  AlignedArray<uint64_t> shifts;  // the pixels': u's are the low bits, v's the high ones
};

// The pair's points of the samples entries[0..count).
void SamplePair(const PairSampler& sampler, size_t pair, const SampleNumbers& samples,
                const uint32_t* entries, size_t count, UnitPoints* points);

}  // namespace nacre
