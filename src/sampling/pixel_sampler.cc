// SPDX-License-Identifier: Apache-2.0
#include "sampling/pixel_sampler.h"

#include <algorithm>
#include <cmath>

#include "sampling/hash.h"
#include "sampling/sobol.h"

namespace nacre {
namespace {

// Appends the first `count` points of a scrambled sequence.
void AppendPoints(int count, uint32_t pair, PixelSampler* sampler) {
  for (int i = 0; i < count; ++i) {
    const Vec2d point = SobolSample2D(static_cast<uint32_t>(i), pair, sampler->seed);
    sampler->points_x.push_back(static_cast<uint32_t>(point.x * 0x1p32));  // exact
    sampler->points_y.push_back(static_cast<uint32_t>(point.y * 0x1p32));
  }
}

}  // namespace

PixelSampler MakePixelSampler(const PixelFilter& filter, int samples_per_pixel, uint32_t seed) {
  if (samples_per_pixel > 1) return MakeReplicateSampler(filter, samples_per_pixel, seed);
  PixelSampler sampler{.filter = MakeFilterSampler(filter), .seed = seed, .centered = true};
  sampler.points_x.resize(kBatchPadding);
  sampler.points_y.resize(kBatchPadding);
  return sampler;
}

PixelSampler MakeReplicateSampler(const PixelFilter& filter, int samples_per_pixel, uint32_t seed) {
  PixelSampler sampler{
      .filter = MakeFilterSampler(filter), .seed = seed, .samples_per_pixel = samples_per_pixel};
  const double positive = PartMass(sampler.filter, FilterPart::kPositive);
  const double negative = PartMass(sampler.filter, FilterPart::kNegative);
  int negative_count = 0;
  if (negative > 0) {
    // Samples are split in proportion to the parts' masses, which is best for parts of equal
    // variance, but each part gets at least one.
    const double share = negative / (positive + negative);
    negative_count = std::clamp(static_cast<int>(std::lround(samples_per_pixel * share)), 1,
                                samples_per_pixel - 1);
    sampler.negative_weight = -negative * samples_per_pixel / negative_count;
  }
  sampler.positive_count = samples_per_pixel - negative_count;
  sampler.positive_weight = positive * samples_per_pixel / sampler.positive_count;
  AppendPoints(sampler.positive_count, 0, &sampler);
  AppendPoints(negative_count, kSobolPairs, &sampler);
  sampler.points_x.resize(sampler.points_x.size() + kBatchPadding);
  sampler.points_y.resize(sampler.points_y.size() + kBatchPadding);
  return sampler;
}

bool HasUnitWeights(const PixelSampler& sampler) {
  return sampler.positive_count == sampler.samples_per_pixel && sampler.positive_weight == 1;
}

PixelSample SamplePixel(const PixelSampler& sampler, int x, int y, int index) {
  if (sampler.centered) return {0, 0, 1};
  const uint64_t shift = PixelSeed(x, y, sampler.seed);
  const auto i = static_cast<size_t>(index);
  const Vec2d u(UnitFromBits(sampler.points_x[i] ^ static_cast<uint32_t>(shift)),
                UnitFromBits(sampler.points_y[i] ^ static_cast<uint32_t>(shift >> 32)));
  if (index < sampler.positive_count) {
    const Vec2d offset = SampleFilter(sampler.filter, FilterPart::kPositive, u);
    return {offset.x, offset.y, sampler.positive_weight};
  }
  const Vec2d offset = SampleFilter(sampler.filter, FilterPart::kNegative, u);
  return {offset.x, offset.y, sampler.negative_weight};
}

double SampleWeight(const PixelSampler& sampler, int index) {
  return index < sampler.positive_count ? sampler.positive_weight : sampler.negative_weight;
}

}  // namespace nacre
