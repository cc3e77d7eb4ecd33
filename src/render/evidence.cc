// SPDX-License-Identifier: Apache-2.0
#include "render/evidence.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace nacre {
namespace {

// Of the pixels 95 % are to be within the wanted error.
constexpr double kMayBeBeyond = 0.05;

// The share of a chi-squared variable with three degrees of freedom at its median, 2.366, over
// three times the 3.182^2 / 1.96^2 by which an interval from four replicates is wider than one of
// a known spread: what the median of a cell's squared half-widths is to the square of the interval
// that the same spread gives where it is known.
constexpr double kOfMedian = 1.96 * 1.96 / (3.182446305 * 3.182446305) / (2.366 / 3);

// What a pixel's samples hit: misses see the background alone.
enum Kind : uint8_t { kMisses, kMixed, kHits };

struct PixelEvidence {
  uint32_t pixel;
  Kind kind;
  double contrast;  // of its samples, in its widest channel
  bool isolated;    // its neighbours do not explain that
};

bool IsOpen(const CellScratch& c, uint32_t pixel) {
  return (c.outlines_only >> pixel / kBlockPixels & 1) == 0;
}

// Rows and columns in the cell, whose blocks lie row by row.
struct CellPlace {
  int column, row;
};

CellPlace PlaceInCell(uint32_t pixel) {
  constexpr uint32_t kAcross = kCellSide / kBlockSide;
  const uint32_t block = pixel / kBlockPixels, in_block = pixel % kBlockPixels;
  return {static_cast<int>(block % kAcross * kBlockSide + in_block % kBlockSide),
          static_cast<int>(block / kAcross * kBlockSide + in_block / kBlockSide)};
}

uint32_t PixelAt(const CellPlace& place) {
  constexpr int kAcross = kCellSide / kBlockSide;
  const int block = place.row / kBlockSide * kAcross + place.column / kBlockSide;
  const int in_block = place.row % kBlockSide * kBlockSide + place.column % kBlockSide;
  return static_cast<uint32_t>(block * static_cast<int>(kBlockPixels) + in_block);
}

double MeanOf(const CellScratch& c, uint32_t pixel, size_t channel) {
  double sum = 0;
  for (const auto& replicate : c.replicate) sum += replicate[channel][pixel];
  return sum / (double{kReplicates} * c.samples[pixel]);
}

Kind KindOf(const CellScratch& c, uint32_t pixel) {
  double hits = 0;
  for (const auto& replicate : c.replicate) hits += replicate[kAlphaSum][pixel];
  const double samples = double{kReplicates} * c.samples[pixel];
  // Weights round.
  if (std::abs(hits) < 1e-6 * samples) return kMisses;
  return std::abs(hits - samples) < 1e-6 * samples ? kHits : kMixed;
}

// Whether what the pixel's samples differ by is more than twice that of the means around it: of an
// edge between two parts of the picture, both sides are seen there.
bool IsIsolated(const CellScratch& c, uint32_t pixel, size_t channel, double contrast) {
  const CellPlace at = PlaceInCell(pixel);
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (int row = std::max(at.row - 1, 0); row <= std::min(at.row + 1, kCellSide - 1); ++row) {
    for (int column = std::max(at.column - 1, 0); column <= std::min(at.column + 1, kCellSide - 1);
         ++column) {
      const uint32_t other = PixelAt({column, row});
      if (c.samples[other] == 0) continue;
      const double mean = MeanOf(c, other, channel);
      low = std::min(low, mean);
      high = std::max(high, mean);
    }
  }
  return 2 * (high - low) < contrast;
}

// What is brighter than `white` counts as that.
PixelEvidence EvidenceOf(const CellScratch& c, uint32_t pixel, double white) {
  PixelEvidence evidence{pixel, KindOf(c, pixel), 0, false};
  size_t widest = 0;
  for (size_t channel = 0; channel < 3; ++channel) {
    const double contrast =
        std::min(c.seen_high[channel][pixel], white) - std::min(c.seen_low[channel][pixel], white);
    if (!(contrast > evidence.contrast)) continue;
    evidence.contrast = contrast;
    widest = channel;
  }
  evidence.isolated = evidence.contrast > 0 && IsIsolated(c, pixel, widest, evidence.contrast);
  return evidence;
}

// What pixels of some kinds tell of one another.
struct Pool {
  double contrast = 0;  // mean of the isolated ones
  double share = 0;     // of the pixels that are isolated
  // Of their half-widths relative to what is wanted, squared, where most are isolated: what then
  // makes their spread is the same in all.
  double median_width2 = 0;
};

// All pixels but those at the cell's border, whose neighbours are not known.
bool IsInner(uint32_t pixel) {
  const CellPlace at = PlaceInCell(pixel);
  return at.column > 0 && at.row > 0 && at.column + 1 < kCellSide && at.row + 1 < kCellSide;
}

Pool PoolOf(const CellScratch& c, const std::vector<PixelEvidence>& all, Kind left_out) {
  Pool pool;
  std::vector<double> widths2;  // of the isolated ones
  size_t inner = 0;
  for (const PixelEvidence& e : all) {
    if (e.kind == left_out || !IsInner(e.pixel)) continue;
    ++inner;
    if (!e.isolated) continue;
    const BlockIntervals& intervals = c.intervals[e.pixel / kBlockPixels];
    const size_t i = e.pixel % kBlockPixels;
    const double width = intervals.half_width[i] / intervals.wanted[i];
    widths2.push_back(width * width);
    pool.contrast += e.contrast;
  }
  if (widths2.size() < 2) return pool;
  const auto isolated = static_cast<double>(widths2.size());
  pool.contrast /= isolated;
  // One alone makes no pattern.
  pool.share = (isolated - 1) / static_cast<double>(inner);
  if (2 * widths2.size() < inner) return pool;
  const auto middle = widths2.begin() + static_cast<std::ptrdiff_t>(widths2.size() / 2);
  std::nth_element(widths2.begin(), middle, widths2.end());
  pool.median_width2 = *middle;
  return pool;
}

// The samples that a pixel needs of which the pool is true. What matters covers wanted / contrast
// of a pixel at least. n samples of a pixel see that with about the probability n wanted /
// contrast, so there are so many times as many pixels with it as are seen; with m samples e^(-m
// wanted / contrast) of them are missed.
double SamplesFor(const Pool& pool, double wanted, double samples) {
  if (pool.share == 0) return 0;
  const double least = wanted / pool.contrast;
  if (least >= 1) return 0;
  const double affected = std::min(pool.share / std::min(samples * least, 1.0), 1.0);
  return std::max(std::log(affected / kMayBeBeyond), 0.0) / least;
}

double SamplesTaken(const CellScratch& c, uint32_t pixel) {
  return double{kReplicates} * c.samples[pixel];
}

double WantedOf(const CellScratch& c, uint32_t pixel) {
  return c.intervals[pixel / kBlockPixels].wanted[pixel % kBlockPixels];
}

// Takes back that the pixel's interval is narrow enough.
void Doubt(uint32_t pixel, CellScratch* c) {
  c->intervals[pixel / kBlockPixels].narrow &= ~(1u << pixel % kBlockPixels);
}

}  // namespace

void ClearEvidence(CellScratch* c) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::fill_n(&c->seen_low[0][0], 3 * kCellPixels, kInfinity);
  std::fill_n(&c->seen_high[0][0], 3 * kCellPixels, -kInfinity);
  std::fill_n(c->least_samples, kCellPixels, 0.0);
}

void RequireEvidence(const RenderPlan& plan, CellScratch* c) {
  std::vector<PixelEvidence> all;
  for (const uint32_t pixel : c->active) {
    if (IsOpen(*c, pixel)) all.push_back(EvidenceOf(*c, pixel, plan.adaptive.white));
  }
  // Pixels with hits and those without tell of those with both, and these of either.
  std::array<Pool, 3> pools;
  pools[kMisses] = PoolOf(*c, all, kHits);
  pools[kHits] = PoolOf(*c, all, kMisses);
  pools[kMixed] = pools[kHits];
  for (const PixelEvidence& e : all) {
    const Pool& pool = pools[e.kind];
    const double wanted = WantedOf(*c, e.pixel), samples = SamplesTaken(*c, e.pixel);
    double& least = c->least_samples[e.pixel];
    least = std::max(least, SamplesFor(pool, wanted, samples));
    const bool by_own = !e.isolated || samples * wanted >= kUnseen * e.contrast;
    const bool by_cell = samples >= least && kOfMedian * pool.median_width2 <= 1;
    if (!by_own || !by_cell) Doubt(e.pixel, c);
  }
  for (const uint32_t pixel : c->active) {
    const bool by_plan = SamplesTaken(*c, pixel) >= c->rare_samples[pixel] ||
                         2 * c->rare_radiance[pixel] <= WantedOf(*c, pixel);
    if (!by_plan) Doubt(pixel, c);
  }
}

}  // namespace nacre
