// SPDX-License-Identifier: Apache-2.0
#include "sampling/pair_sampler.h"

#include "sampling/hash.h"
#include "sampling/sobol.h"

namespace nacre {

PairSampler MakePairSampler(int samples, size_t pairs, uint32_t seed) {
  PairSampler sampler;
  sampler.samples = static_cast<size_t>(samples);
  sampler.u_bits.reserve(pairs * sampler.samples);
  sampler.v_bits.reserve(pairs * sampler.samples);
  for (size_t pair = 0; pair < pairs; ++pair) {
    for (uint32_t i = 0; i < sampler.samples; ++i) {
      const auto first = static_cast<uint32_t>((1 + pair) * kSobolPairs);
      const Vec2d point = SobolSample2D(i, first, seed);
      sampler.u_bits.push_back(static_cast<uint32_t>(point.x * 0x1p32));  // exact
      sampler.v_bits.push_back(static_cast<uint32_t>(point.y * 0x1p32));
    }
  }
  return sampler;
}

void SamplePair(const PairSampler& sampler, size_t pair, const SampleNumbers& samples,
                const uint32_t* entries, size_t count, UnitPoints* points) {
  const uint32_t* const u_bits = sampler.u_bits.data() + pair * sampler.samples;
  const uint32_t* const v_bits = sampler.v_bits.data() + pair * sampler.samples;
  // Adding a constant and Mix64 are bijections, so pixels whose seeds differ have different shifts.
  // The pixel sampler's shift is the seed itself.
  const uint64_t key = (pair + 1) * 0x9e3779b97f4a7c15u;
  for (size_t i = 0; i < samples.pixel_count; ++i) {
    points->shifts[i] = Mix64(samples.seeds[i] + key);
  }
  for (size_t i = 0; i < count; ++i) {
    const uint32_t entry = entries[i];
    const uint32_t number = samples.number[entry];
    const uint64_t shift = points->shifts[samples.pixel[entry]];
    points->u_bits[i] = u_bits[number] ^ static_cast<uint32_t>(shift);
    points->v_bits[i] = v_bits[number] ^ static_cast<uint32_t>(shift >> 32);
  }
  for (size_t i = 0; i < count; ++i) {
    points->u[i] = static_cast<float>(points->u_bits[i] >> 8) * 0x1p-24f;
    points->v[i] = static_cast<float>(points->v_bits[i] >> 8) * 0x1p-24f;
  }
}

}  // namespace nacre
