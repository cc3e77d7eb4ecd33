// SPDX-License-Identifier: Apache-2.0
#include "render/convergence.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/film.h"
#include "render/outline_coverage.h"

namespace nacre {
namespace {

constexpr double kUnbounded = std::numeric_limits<double>::infinity();

// Student's t: 97.5 % of the distribution with three degrees of freedom lie below.
constexpr double kStudent = 3.182446305;

// A peak narrower than a pixel may fall between its samples, but its neighbours' see the flanks: a
// pixel goes on while they go on, too, with intervals wider than this many times what it wants.
constexpr double kNeighbourSlack = 8;

// Levels that a block takes, 16 samples a pixel, before it may stop: an edge that cuts a corner off
// shows in none of four samples too often. Half of them do where all edges are outlines, of which
// the pixels know. Then it stops as a whole, or its pixels one by one.
size_t CommonLevels(const CellScratch& c, size_t block) {
  return kCommonLevels - (c.outlines_only >> block & 1);
}

// The ranges of the samples that hit in the pixels on outlines.
void FindOutlineRanges(CellScratch* c) {
  for (size_t channel = 0; channel < 3; ++channel) {
    std::fill_n(c->outline_range[channel], kCellBlocks, PixelRange{kUnbounded, -kUnbounded});
    for (const uint32_t pixel : c->active) {
      if (!c->on_outline[pixel]) continue;
      PixelRange& range = c->outline_range[channel][pixel / kBlockPixels];
      range.low = std::min(range.low, c->low[channel][pixel]);
      range.high = std::max(range.high, c->high[channel][pixel]);
    }
  }
}

// The mean of a pixel's samples in a channel, and the half-width of its interval, squared.
struct Measured {
  double mean, half_width2;
};

Measured MeasureSpread(const double (&values)[kReplicates]) {
  double mean = 0, squares = 0;
  for (const double value : values) mean += value;
  mean *= 1.0 / kReplicates;
  for (const double value : values) squares += (value - mean) * (value - mean);
  constexpr double kFactor = kStudent * kStudent / ((kReplicates - 1) * kReplicates);
  return {mean, kFactor * squares};
}

// The most by which samples of a pixel on an outline may differ from `mean`: as much as those on
// the block's outlines that hit, as the background, or as black does.
double Contrast(const PixelRange& range, double background, double mean) {
  return std::max(
      {range.high - mean, mean - range.low, std::abs(background - mean), std::abs(mean), kDarkest});
}

// A pixel that an outline crosses. All samples may miss a sliver, and then agree; and so may the
// replicates' shares of hits. The interval is never narrower than what one more sample might tell.
Measured MeasureOnOutline(const double (&values)[kReplicates], const PixelRange& range,
                          double background, double samples) {
  Measured measured = MeasureSpread(values);
  const double least = Contrast(range, background, measured.mean) / samples;
  measured.half_width2 = std::max(measured.half_width2, least * least);
  return measured;
}

// The same where it is known what share of the pixel is covered. What is measured is then the mean
// of the samples that hit: a share of them that is wrong by chance is taken back from each
// replicate. One hit tells nothing of the others: they may differ as those around do.
Measured MeasureCovered(const double (&values)[kReplicates], const double (&hits)[kReplicates],
                        double covered, const PixelRange& range, double background,
                        double samples) {
  double all_hits = 0, excess = 0;
  for (size_t r = 0; r < kReplicates; ++r) {
    all_hits += hits[r];
    excess += values[r] - background;
  }
  if (all_hits == 0) {
    const double least = covered * Contrast(range, background, background);
    return {background, least * least};
  }
  const double of_hit = excess / all_hits;
  double corrected[kReplicates];
  for (size_t r = 0; r < kReplicates; ++r) corrected[r] = values[r] - of_hit * (hits[r] - covered);
  Measured measured = MeasureSpread(corrected);
  const double spread = range.low <= range.high ? range.high - range.low : std::abs(of_hit);
  const double least = covered * spread / (all_hits * samples / kReplicates);
  measured.half_width2 = std::max(measured.half_width2, least * least);
  return measured;
}

// The spread of a pixel in a channel of the beauty.
Measured Measure(const CellScratch& c, uint32_t pixel, int channel, double background) {
  const double scale = 1.0 / c.samples[pixel], samples = double{kReplicates} * c.samples[pixel];
  double values[kReplicates];
  for (size_t r = 0; r < kReplicates; ++r) values[r] = c.replicate[r][channel][pixel] * scale;
  if (!c.on_outline[pixel]) return MeasureSpread(values);
  const PixelRange& range = c.outline_range[channel][pixel / kBlockPixels];
  if (c.covered[pixel] < 0) return MeasureOnOutline(values, range, background, samples);
  double hits[kReplicates];
  for (size_t r = 0; r < kReplicates; ++r) hits[r] = c.replicate[r][kAlphaSum][pixel] * scale;
  return MeasureCovered(values, hits, c.covered[pixel], range, background, samples);
}

// The pixel's interval and what is wanted of it. NaN never converges: it is counted where the
// picture is written.
void MeasurePixel(double max_error, const Rgb& background, uint32_t pixel, CellScratch* c) {
  PixelInterval& interval = c->intervals[pixel];
  interval.wanted = kUnbounded;
  double widest = 0;
  bool narrow = true;
  for (int channel = 0; channel < 3; ++channel) {
    const Measured measured = Measure(*c, pixel, channel, background[channel]);
    const double wanted = max_error * std::max(std::abs(measured.mean), kDarkest);
    narrow = narrow && measured.half_width2 <= wanted * wanted;
    widest = std::max(widest, measured.half_width2);
    interval.wanted = std::min(interval.wanted, wanted);
  }
  interval.narrow = narrow;
  interval.half_width = std::sqrt(widest);
}

// What is covered of the pixel around (x, y), which the outline of the sphere may cross; -1 where
// that is not known.
double CoveredOf(const RenderPlan& plan, const TraceSphere* sphere, double x, double y) {
  if (sphere == nullptr || plan.adaptive.square == 0) return -1;
  const OutlineForm outline = OutlineAround(plan.camera, *sphere, x, y);
  return BendsLittle(outline) ? CoveredShare(outline, plan.adaptive.square) : -1;
}

// The widest interval of the pixels around one, in its block, that are not yet as narrow as wanted.
double WidestAround(const CellScratch& c, uint32_t pixel) {
  const uint32_t first = pixel - pixel % uint32_t{kBlockPixels};
  const int x = static_cast<int>(pixel % kBlockSide);
  const int y = static_cast<int>(pixel % kBlockPixels) / kBlockSide;
  double widest = 0;
  for (int row = std::max(y - 1, 0); row <= std::min(y + 1, kBlockSide - 1); ++row) {
    for (int column = std::max(x - 1, 0); column <= std::min(x + 1, kBlockSide - 1); ++column) {
      const auto i = first + static_cast<uint32_t>(row * kBlockSide + column);
      if (!c.intervals[i].narrow) widest = std::max(widest, c.intervals[i].half_width);
    }
  }
  return widest;
}

}  // namespace

void FindOutlines(const RenderPlan& plan, const Window& cell, CellScratch* c) {
  c->outlined = 0;
  std::fill_n(c->on_outline, kCellPixels, false);
  std::fill_n(c->covered, kCellPixels, -1.0);
  std::fill_n(&c->low[0][0], 3 * kCellPixels, kUnbounded);
  std::fill_n(&c->high[0][0], 3 * kCellPixels, -kUnbounded);
  if (!c->pictures) return;
  const double reach = plan.adaptive.reach;
  for (const uint32_t i : c->active) {
    const FilmPixel pixel = PixelOf(cell, i);
    const double x = pixel.x + 0.5, y = pixel.y + 0.5;
    const SeenOutlines seen = OutlinesAround(plan.camera, *c->pictures, x, y, reach);
    if (!seen.any) continue;
    const double covered = CoveredOf(plan, seen.alone, x, y);
    if (covered == 0 || covered == 1) continue;
    c->on_outline[i] = true;
    c->covered[i] = covered;
    c->outlined |= 1u << i / kBlockPixels;
  }
}

void DropConverged(const RenderPlan& plan, size_t level, CellScratch* c) {
  if (level + 2 < kCommonLevels) return;
  if (level + 2 == kCommonLevels) FindOutlineRanges(c);
  const Rgb background = BackgroundOf(plan.layers[0], plan);  // the beauty's
  uint32_t open = 0;                                          // blocks, as bits
  for (const uint32_t pixel : c->active) {
    MeasurePixel(plan.adaptive.max_error, background, pixel, c);
    if (!c->intervals[pixel].narrow) open |= 1u << pixel / kBlockPixels;
  }
  std::erase_if(c->active, [&](uint32_t pixel) {
    const size_t block = pixel / kBlockPixels, common = CommonLevels(*c, block);
    if (level + 1 < common) return false;
    if (level + 1 == common) return (open >> block & 1) == 0;
    const PixelInterval& interval = c->intervals[pixel];
    return interval.narrow && WidestAround(*c, pixel) <= kNeighbourSlack * interval.wanted;
  });
}

}  // namespace nacre
