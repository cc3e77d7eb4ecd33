// SPDX-License-Identifier: Apache-2.0
#include "render/evidence.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

namespace nacre {
namespace {

// The share of pixels whose error may exceed the tolerance: intervals are 95 % confidence
// intervals.
constexpr double kAllowedShare = 0.05;

// Whether none, some or all of a pixel's samples hit a shape.
enum HitKind : uint8_t { kMisses, kMixed, kHits };

struct PixelEvidence {
  uint32_t pixel;
  HitKind kind;
  double contrast;  // largest difference of its samples in any channel
  double single;    // the largest difference of one extreme sample from the next to it
  bool isolated;    // the contrast is more than twice that of the means around the pixel
};

// Whether a rare feature may be hidden in the pixel.
bool MayHideFeatures(const CellState& c, uint32_t pixel) {
  if (c.dust.sampled_share[pixel] < 1) return c.dust.sampled_share[pixel] > 0;
  return (c.edges.only_outlines >> pixel / kBlockPixels & 1) == 0;
}

double SamplesTaken(const CellSamples& samples, uint32_t pixel) {
  return double{kReplicates} * samples.count[pixel];
}

double MeanOf(const CellSamples& samples, uint32_t pixel, size_t channel) {
  double sum = 0;
  for (const auto& replicate : samples.sums) sum += replicate[channel][pixel];
  return sum / SamplesTaken(samples, pixel);
}

HitKind Classify(const CellSamples& samples, uint32_t pixel) {
  double hits = 0;
  for (const auto& replicate : samples.sums) hits += replicate[kAlphaSum][pixel];
  const double count = SamplesTaken(samples, pixel);
  // Sums of weights have rounding errors.
  if (std::abs(hits) < 1e-6 * count) return kMisses;
  return std::abs(hits - count) < 1e-6 * count ? kHits : kMixed;
}

// The range of the means of the pixel and its neighbours in the cell.
PixelRange RangeOfMeans(const CellSamples& samples, uint32_t pixel, size_t channel) {
  const FilmPixel at = PixelOf({}, pixel);
  PixelRange range{std::numeric_limits<double>::infinity(),
                   -std::numeric_limits<double>::infinity()};
  for (int row = std::max(at.y - 1, 0); row <= std::min(at.y + 1, kCellSize - 1); ++row) {
    for (int column = std::max(at.x - 1, 0); column <= std::min(at.x + 1, kCellSize - 1);
         ++column) {
      const uint32_t other = PixelAt(column, row);
      if (samples.count[other] == 0) continue;
      const double mean = MeanOf(samples, other, channel);
      range.low = std::min(range.low, mean);
      range.high = std::max(range.high, mean);
    }
  }
  return range;
}

PixelEvidence EvidenceOf(const CellSamples& samples, const CellEvidence& of, uint32_t pixel) {
  PixelEvidence evidence{pixel, Classify(samples, pixel), 0, 0, false};
  size_t widest = 0;
  for (size_t channel = 0; channel < 3; ++channel) {
    const double lowest = of.lowest[channel][pixel];
    const double second_lowest = of.second_lowest[channel][pixel];
    const double second_highest = of.second_highest[channel][pixel];
    const double highest = of.highest[channel][pixel];
    evidence.single = std::max({evidence.single, second_lowest - lowest, highest - second_highest});
    if (!(highest - lowest > evidence.contrast)) continue;
    evidence.contrast = highest - lowest;
    widest = channel;
  }
  if (!(evidence.contrast > 0)) return evidence;
  // At an edge between two areas of the picture, both sides appear among the neighbours.
  const PixelRange means = RangeOfMeans(samples, pixel, widest);
  evidence.isolated = 2 * (means.high - means.low) < evidence.contrast;
  return evidence;
}

// The evidence in a cell's pixels of rare features that other pixels may have (evidence.h).
struct Pool {
  double contrast = 0;  // mean of PixelEvidence::single of the witnesses
  double share = 0;     // of the pixels that are witnesses
};

// All pixels except those at the cell's border, whose neighbours are not known.
bool IsInner(uint32_t pixel) {
  const FilmPixel at = PixelOf({}, pixel);
  return at.x > 0 && at.y > 0 && at.x + 1 < kCellSize && at.y + 1 < kCellSize;
}

// Whether all rare features of the pixel that matter are known beforehand.
bool IsExplained(const CellState& c, uint32_t pixel) {
  return c.evidence.required_samples[pixel] > 0 && !c.known.has_other_texels[pixel];
}

// The error of the pixel's mean if no sample has hit this rare feature. It counts only as far as it
// is darker or brighter than everything around it; otherwise it is part of an edge.
double MissingContrast(const CellSamples& samples, const RarePart& rare) {
  double contrast = 0;
  for (size_t channel = 0; channel < 3; ++channel) {
    const PixelRange around = RangeOfMeans(samples, rare.pixel, channel);
    const double radiance = rare.radiance[static_cast<int>(channel)];
    contrast = std::max(
        {contrast, radiance - rare.share * around.high, rare.share * around.low - radiance});
  }
  return contrast;
}

// The rare features of one pixel matter together. Features that contribute less than an equal share
// of half the tolerance are left out: all of these together cannot matter.
double SamplesForParts(std::span<const RarePart> of_pixel, const CellSamples& samples,
                       double sampled_share, double tolerance) {
  double all = 0, required = 0;
  for (const RarePart& rare : of_pixel) all += MissingContrast(samples, rare);
  if (!(2 * all > tolerance)) return 0;
  const auto count = static_cast<double>(of_pixel.size());
  for (const RarePart& rare : of_pixel) {
    if (!(2 * count * MissingContrast(samples, rare) > tolerance)) continue;
    required = std::max(required, kExpectedHits * sampled_share / rare.share);
  }
  return required;
}

// Sets required_samples of the pixels that have samples.
void RequireKnownFeatures(CellState* c) {
  double* const required_samples = c->evidence.required_samples;
  for (uint32_t pixel = 0; pixel < kCellPixels; ++pixel) {
    const bool matters = 2 * c->known.radiance[pixel] > c->intervals.tolerance[pixel];
    required_samples[pixel] = matters ? c->known.samples[pixel] : 0;
  }
  const std::vector<RarePart>& all = c->known.parts;
  for (size_t first = 0, end = 0; first < all.size(); first = end) {
    const uint32_t pixel = all[first].pixel;
    while (end < all.size() && all[end].pixel == pixel) ++end;
    if (c->samples.count[pixel] == 0) continue;
    required_samples[pixel] =
        std::max(required_samples[pixel],
                 SamplesForParts({all.data() + first, end - first}, c->samples,
                                 c->dust.sampled_share[pixel], c->intervals.tolerance[pixel]));
  }
}

// Pools the evidence of all pixels except those of the kind `left_out` and those whose rare
// features are known: a known feature is known in every pixel that has it.
Pool MakePool(const CellState& c, const std::vector<PixelEvidence>& all, HitKind left_out) {
  Pool pool;
  size_t inner = 0, witnesses = 0;
  for (const PixelEvidence& e : all) {
    if (e.kind == left_out || !IsInner(e.pixel) || IsExplained(c, e.pixel)) continue;
    ++inner;
    if (!e.isolated || e.single <= c.intervals.tolerance[e.pixel]) continue;
    pool.contrast += e.single;
    ++witnesses;
  }
  // A single witness is no evidence of others.
  if (witnesses < 2) return {};
  pool.contrast /= static_cast<double>(witnesses);
  pool.share = static_cast<double>(witnesses - 1) / static_cast<double>(inner);
  return pool;
}

// The number of samples that a pixel needs by the evidence of the pool (evidence.h).
double RequiredSamples(const Pool& pool, double tolerance, double samples) {
  if (pool.share == 0) return 0;
  const double least = tolerance / pool.contrast;
  if (least >= 1) return 0;
  const double affected = std::min(pool.share / std::min(samples * least, 1.0), 1.0);
  return std::max(std::log(affected / kAllowedShare), 0.0) / least;
}

}  // namespace

void ClearEvidence(CellEvidence* evidence) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (auto* low : {evidence->lowest, evidence->second_lowest})
    std::fill_n(&low[0][0], 3 * kCellPixels, kInfinity);
  for (auto* high : {evidence->highest, evidence->second_highest})
    std::fill_n(&high[0][0], 3 * kCellPixels, -kInfinity);
}

void RequireEvidence(CellState* c) {
  RequireKnownFeatures(c);
  std::vector<PixelEvidence> all;
  for (const uint32_t pixel : c->active) {
    if (MayHideFeatures(*c, pixel)) all.push_back(EvidenceOf(c->samples, c->evidence, pixel));
  }
  // Pixels that miss are judged by misses and mixed pixels, all others by hits and mixed pixels.
  const Pool of_misses = MakePool(*c, all, kHits), of_hits = MakePool(*c, all, kMisses);
  for (const PixelEvidence& e : all) {
    const double tolerance = c->intervals.tolerance[e.pixel];
    const double samples = SamplesTaken(c->samples, e.pixel);
    const bool enough_for_pixel =
        c->outlines.coverage[e.pixel] >= 0 || samples * tolerance >= kByChance * e.contrast;
    const bool enough_for_cell =
        samples >= RequiredSamples(e.kind == kMisses ? of_misses : of_hits, tolerance, samples);
    if (!enough_for_pixel || !enough_for_cell) c->intervals.narrow[e.pixel] = false;
  }
  for (const uint32_t pixel : c->active) {
    if (SamplesTaken(c->samples, pixel) < c->evidence.required_samples[pixel]) {
      c->intervals.narrow[pixel] = false;
    }
  }
}

}  // namespace nacre
