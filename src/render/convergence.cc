// SPDX-License-Identifier: Apache-2.0
#include "render/convergence.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/film.h"
#include "render/interval.h"

namespace nacre {
namespace {

constexpr double kUnbounded = std::numeric_limits<double>::infinity();

// A peak narrower than a pixel may lie between the pixel's samples while its neighbours' samples
// hit the flanks. So a pixel stays active while a neighbour has an interval that is wider than this
// many times the pixel's own tolerance.
constexpr double kNeighbourSlack = 8;

// How many levels a block takes before it may stop: 16 samples a pixel with most filters, because
// four samples miss an edge that cuts off the corner of a pixel too often. One level less, that is,
// half of the samples, is enough where the only edges are outlines, whose pixels are known.
size_t CommonLevels(const CellState& c, size_t block) {
  return kCommonLevels - ((c.edges.only_outlines & c.outlines.blocks) >> block & 1);
}

// The interval of a pixel in one channel of the beauty.
Interval MeasureChannel(const CellState& c, uint32_t pixel, int channel, double background) {
  const CellSamples& of = c.samples;
  const double scale = 1.0 / of.count[pixel], samples = double{kReplicates} * of.count[pixel];
  double values[kReplicates];
  for (size_t r = 0; r < kReplicates; ++r) values[r] = of.sums[r][channel][pixel] * scale;
  if (!c.outlines.on_outline[pixel]) return MeasureSpread(values);
  const PixelRange& range = c.outlines.hit_range[channel][pixel / kBlockPixels];
  if (c.outlines.coverage[pixel] < 0) {
    return MeasureOnOutline(values, range,
                            c.outlines.sees_background[pixel] ? &background : nullptr, samples);
  }
  double hits[kReplicates];
  for (size_t r = 0; r < kReplicates; ++r) hits[r] = of.sums[r][kAlphaSum][pixel] * scale;
  return MeasureCovered(values, hits, c.outlines.coverage[pixel], range, background, samples);
}

// Written so that NaN never converges; NaN is counted and reported where the picture is written.
void MeasurePixel(const ErrorBound& error, const Rgb& background, uint32_t pixel, CellState* c) {
  double widest = 0, strictest = kUnbounded;
  bool narrow = true;
  for (int channel = 0; channel < 3; ++channel) {
    const Interval interval = MeasureChannel(*c, pixel, channel, background[channel]);
    const double tolerance = ToleranceAt(error, interval.mean);
    narrow = narrow && interval.half_width2 <= tolerance * tolerance;
    widest = std::max(widest, interval.half_width2);
    strictest = std::min(strictest, tolerance);
  }
  c->intervals.narrow[pixel] = narrow;
  c->intervals.half_width[pixel] = std::sqrt(widest);
  c->intervals.tolerance[pixel] = strictest;
}

// Measures the active pixels, and judges whether they have samples enough. The others keep their
// intervals: they take no samples that would change them.
void MeasureActive(const ErrorBound& error, const Rgb& background, CellState* c) {
  for (const uint32_t pixel : c->active) MeasurePixel(error, background, pixel, c);
  RequireEvidence(c);
}

// The largest half-width among the neighbours in the block that are not within their tolerance.
double WidestNeighbour(const CellState& c, uint32_t pixel) {
  const uint32_t block = pixel - pixel % uint32_t{kBlockPixels};
  const int x = static_cast<int>(pixel % kBlockSide);
  const int y = static_cast<int>(pixel % kBlockPixels) / kBlockSide;
  double widest = 0;
  for (int row = std::max(y - 1, 0); row <= std::min(y + 1, kBlockSide - 1); ++row) {
    for (int column = std::max(x - 1, 0); column <= std::min(x + 1, kBlockSide - 1); ++column) {
      const uint32_t other = block + static_cast<uint32_t>(row * kBlockSide + column);
      // Rare features are known for each pixel by itself, and say nothing about its neighbours.
      if (c.intervals.narrow[other] || c.evidence.required_samples[other] > 0) continue;
      widest = std::max(widest, c.intervals.half_width[other]);
    }
  }
  return widest;
}

bool HasConverged(const CellState& c, uint32_t pixel) {
  if (c.dust.sampled_share[pixel] == 0) return true;  // it is the background
  return c.intervals.narrow[pixel] &&
         WidestNeighbour(c, pixel) <= kNeighbourSlack * c.intervals.tolerance[pixel];
}

}  // namespace

void DropConverged(const FramePlan& plan, size_t level, CellState* c) {
  if (level + 2 < kCommonLevels) return;
  if (level + 2 == kCommonLevels) FindHitRanges(c->active, &c->outlines);
  const Rgb background = BackgroundOf(plan.film.layers[0], plan.film);  // the beauty's
  MeasureActive({plan.adaptive.max_error, plan.adaptive.white}, background, c);
  uint32_t open = 0;  // blocks, as bits, with pixels beyond their tolerance
  for (const uint32_t pixel : c->active) {
    if (!c->intervals.narrow[pixel]) open |= 1u << pixel / kBlockPixels;
  }
  std::erase_if(c->active, [&](uint32_t pixel) {
    const size_t block = pixel / kBlockPixels, common = CommonLevels(*c, block);
    if (level + 1 < common) return false;
    if (level + 1 == common) return (open >> block & 1) == 0;
    return HasConverged(*c, pixel);
  });
}

size_t CountUnsettled(const FramePlan& plan, const Window& cell, const Window& part, CellState* c) {
  if (c->active.empty()) return 0;
  // With so few levels no pixel has been dropped, and nothing measured.
  if (plan.adaptive.sampling.levels.size() + 1 < kCommonLevels)
    FindHitRanges(c->active, &c->outlines);
  MeasureActive({plan.adaptive.max_error, kUnbounded}, BackgroundOf(plan.film.layers[0], plan.film),
                c);
  return static_cast<size_t>(std::count_if(c->active.begin(), c->active.end(), [&](uint32_t pixel) {
    const FilmPixel at = PixelOf(cell, pixel);
    const bool shown = at.x >= part.x0 && at.x < part.x1 && at.y >= part.y0 && at.y < part.y1;
    return shown && !HasConverged(*c, pixel);
  }));
}

}  // namespace nacre
