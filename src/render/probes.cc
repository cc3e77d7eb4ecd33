// SPDX-License-Identifier: Apache-2.0
#include "render/probes.h"

#include <algorithm>
#include <span>

#include "sampling/hash.h"

namespace nacre {
namespace {

// Samples of a probe if lights are sampled: one sample would be too noisy.
constexpr size_t kSamplesPerProbe = 8;

void TraceBatch(const FramePlan& plan, bool alike, std::span<Probe> probes, size_t each,
                TileWork* work) {
  TileWork& s = *work;
  for (size_t i = 0; i < probes.size(); ++i) {
    std::fill_n(s.samples.film.x.data() + each * i, each, probes[i].x);
    std::fill_n(s.samples.film.y.data() + each * i, each, probes[i].y);
  }
  s.samples.film.count = each * probes.size();
  if (plan.sampling.numbered) {
    const auto seed_of = [&](size_t i) { return alike ? 0 : HashCombine(probes[i].seed, i); };
    NumberPixelByPixel(probes.size(), 0, each, seed_of, &EnsureNumbers(&s.samples));
  }
  ShadeSamples(plan, &s);
  for (size_t hit = 0; hit < s.surfaces.hits.count; ++hit) {
    probes[s.surfaces.hits.ray[hit] / each].hit = s.surfaces.hits.primitive[hit];
  }
  const Layer& beauty = plan.film.layers[0];
  Soa3<double>& values = GatherLayer(plan.film, beauty, BackgroundOf(beauty, plan.film),
                                     BatchOf(plan, s), &s.layer_room);
  for (size_t i = 0; i < probes.size(); ++i) {
    for (int channel = 0; channel < 3; ++channel) {
      const double* const value = ChannelOf(values, channel).data() + each * i;
      double sum = 0;
      for (size_t k = 0; k < each; ++k) sum += value[k];
      probes[i].radiance[channel] = sum / static_cast<double>(each);
    }
  }
}

}  // namespace

void TraceProbes(const FramePlan& plan, bool alike, std::vector<Probe>* probes, TileWork* work) {
  const size_t each = plan.sampling.numbered && !alike ? kSamplesPerProbe : 1;
  const size_t per_batch = kBatchCapacity / each;
  for (size_t first = 0; first < probes->size(); first += per_batch) {
    const size_t count = std::min(per_batch, probes->size() - first);
    TraceBatch(plan, alike, {probes->data() + first, count}, each, work);
  }
}

}  // namespace nacre
