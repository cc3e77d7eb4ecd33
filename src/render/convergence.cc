// SPDX-License-Identifier: Apache-2.0
#include "render/convergence.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/evidence.h"
#include "render/film.h"
#include "render/interval.h"
#include "render/outline_coverage.h"

namespace nacre {
namespace {

constexpr double kUnbounded = std::numeric_limits<double>::infinity();

// A peak narrower than a pixel may fall between its samples, but its neighbours' see the flanks: a
// pixel goes on while they go on, too, with intervals wider than this many times what it wants.
constexpr double kNeighbourSlack = 8;

// Levels that a block takes before it may stop, of most filters 16 samples a pixel: an edge that
// cuts a corner off shows in none of four samples too often. Half of them do for a block of
// outlines, of which the pixels know. Then it stops as a whole, or its pixels one by one.
size_t CommonLevels(const CellScratch& c, size_t block) {
  return kCommonLevels - ((c.outlines_only & c.outlined) >> block & 1);
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

// The spread of a pixel on an outline in a channel of the beauty.
Measured Measure(const CellScratch& c, uint32_t pixel, int channel, double background) {
  const double scale = 1.0 / c.samples[pixel], samples = double{kReplicates} * c.samples[pixel];
  double values[kReplicates];
  for (size_t r = 0; r < kReplicates; ++r) values[r] = c.replicate[r][channel][pixel] * scale;
  const PixelRange& range = c.outline_range[channel][pixel / kBlockPixels];
  if (c.covered[pixel] < 0) {
    return MeasureOnOutline(values, range, c.sees_background[pixel] ? &background : nullptr,
                            samples);
  }
  double hits[kReplicates];
  for (size_t r = 0; r < kReplicates; ++r) hits[r] = c.replicate[r][kAlphaSum][pixel] * scale;
  return MeasureCovered(values, hits, c.covered[pixel], range, background, samples);
}

// Takes a pixel's interval over.
void SetInterval(const BlockIntervals& from, uint32_t i, BlockIntervals* to) {
  to->narrow = (to->narrow & ~(1u << i)) | (from.narrow & 1u << i);
  to->half_width[i] = from.half_width[i];
  to->wanted[i] = from.wanted[i];
}

// The interval of a pixel on an outline and what is wanted of it. NaN never converges: it is
// counted where the picture is written.
void MeasurePixel(const WantedError& error, const Rgb& background, uint32_t pixel, CellScratch* c) {
  BlockIntervals& intervals = c->intervals[pixel / kBlockPixels];
  const size_t i = pixel % kBlockPixels;
  double widest = 0, strictest = kUnbounded;
  bool narrow = true;
  for (int channel = 0; channel < 3; ++channel) {
    const Measured measured = Measure(*c, pixel, channel, background[channel]);
    const double wanted = Wanted(error, measured.mean);
    narrow = narrow && measured.half_width2 <= wanted * wanted;
    widest = std::max(widest, measured.half_width2);
    strictest = std::min(strictest, wanted);
  }
  intervals.wanted[i] = strictest;
  intervals.half_width[i] = std::sqrt(widest);
  intervals.narrow = (intervals.narrow & ~(1u << i)) | uint32_t{narrow} << i;
}

// Measures a block's pixels; of those on outlines only the active ones, whose samples are new.
void MeasureOneBlock(const WantedError& error, const Rgb& background, size_t block, uint32_t active,
                     CellScratch* c) {
  const auto first = static_cast<uint32_t>(block * kBlockPixels);
  const double* sums[kReplicates][3];
  for (size_t r = 0; r < kReplicates; ++r) {
    for (size_t channel = 0; channel < 3; ++channel) {
      sums[r][channel] = c->replicate[r][channel] + first;
    }
  }
  const BlockIntervals before = c->intervals[block];
  MeasureBlock(sums, c->samples + first, error, &c->intervals[block]);
  if ((c->outlined >> block & 1) == 0) return;
  for (uint32_t i = 0; i < kBlockPixels; ++i) {
    if (!c->on_outline[first + i]) continue;
    if ((active >> i & 1) != 0) {
      MeasurePixel(error, background, first + i, c);
    } else {
      SetInterval(before, i, &c->intervals[block]);
    }
  }
}

void MeasureActive(const WantedError& error, const Rgb& background, CellScratch* c) {
  uint32_t active[kCellBlocks] = {};  // pixels, as bits
  for (const uint32_t pixel : c->active) active[pixel / kBlockPixels] |= 1u << pixel % kBlockPixels;
  for (size_t block = 0; block < kCellBlocks; ++block) {
    if (active[block] != 0) MeasureOneBlock(error, background, block, active[block], c);
  }
}

bool IsNarrow(const CellScratch& c, uint32_t pixel) {
  return (c.intervals[pixel / kBlockPixels].narrow >> pixel % kBlockPixels & 1) != 0;
}

// A pixel that an outline may cross.
void FindCovered(const FramePlan& plan, const SeenOutlines& seen, uint32_t pixel, double x,
                 double y, CellScratch* c) {
  const double square = plan.adaptive.square;
  double covered = -1;
  if (seen.alone != nullptr && square > 0) {
    const OutlineForm outline = OutlineAround(plan.camera, *seen.alone, x, y);
    if (BendsLittle(outline)) covered = CoveredShare(outline, square);
    if (covered > 0 && covered < 1) {
      const FilmStep step = CoveredPlace(outline, square);
      c->sought.push_back({pixel, x + step.dx, y + step.dy});
    }
  }
  if (covered == 0 || covered == 1) return;  // it does not
  c->on_outline[pixel] = true;
  c->sees_background[pixel] = seen.background;
  c->covered[pixel] = covered;
  c->outlined |= 1u << pixel / kBlockPixels;
}

// The widest interval of the pixels around one, in its block, that are not yet as narrow as wanted.
double WidestAround(const CellScratch& c, uint32_t pixel) {
  const BlockIntervals& intervals = c.intervals[pixel / kBlockPixels];
  const int x = static_cast<int>(pixel % kBlockSide);
  const int y = static_cast<int>(pixel % kBlockPixels) / kBlockSide;
  double widest = 0;
  for (int row = std::max(y - 1, 0); row <= std::min(y + 1, kBlockSide - 1); ++row) {
    for (int column = std::max(x - 1, 0); column <= std::min(x + 1, kBlockSide - 1); ++column) {
      const auto i = static_cast<uint32_t>(row * kBlockSide + column);
      if ((intervals.narrow >> i & 1) != 0) continue;
      // What is known to be rare there is known here, too.
      const uint32_t other = pixel - pixel % uint32_t{kBlockPixels} + i;
      if (c.known_rare[other] > 0) continue;
      widest = std::max(widest, intervals.half_width[i]);
    }
  }
  return widest;
}

bool HasSettled(const CellScratch& c, uint32_t pixel) {
  const double wanted = c.intervals[pixel / kBlockPixels].wanted[pixel % kBlockPixels];
  return IsNarrow(c, pixel) && WidestAround(c, pixel) <= kNeighbourSlack * wanted;
}

}  // namespace

void FindOutlines(const FramePlan& plan, const Window& cell, CellScratch* c) {
  c->outlined = 0;
  c->sought.clear();
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
    if (seen.any) FindCovered(plan, seen, i, x, y, c);
  }
}

void DropConverged(const FramePlan& plan, size_t level, CellScratch* c) {
  if (level + 2 < kCommonLevels) return;
  if (level + 2 == kCommonLevels) FindOutlineRanges(c);
  const Rgb background = BackgroundOf(plan.film.layers[0], plan.film);  // the beauty's
  MeasureActive({plan.adaptive.max_error, plan.adaptive.white}, background, c);
  RequireEvidence(c);
  uint32_t open = 0;  // blocks, as bits
  for (const uint32_t pixel : c->active) {
    if (!IsNarrow(*c, pixel)) open |= 1u << pixel / kBlockPixels;
  }
  std::erase_if(c->active, [&](uint32_t pixel) {
    const size_t block = pixel / kBlockPixels, common = CommonLevels(*c, block);
    if (level + 1 < common) return false;
    if (level + 1 == common) return (open >> block & 1) == 0;
    return HasSettled(*c, pixel);
  });
}

size_t CountUnsettled(const FramePlan& plan, const Window& cell, const Window& part,
                      CellScratch* c) {
  if (c->active.empty()) return 0;
  MeasureActive({plan.adaptive.max_error, kUnbounded}, BackgroundOf(plan.film.layers[0], plan.film),
                c);
  RequireEvidence(c);
  return static_cast<size_t>(std::count_if(c->active.begin(), c->active.end(), [&](uint32_t pixel) {
    const FilmPixel at = PixelOf(cell, pixel);
    const bool shown = at.x >= part.x0 && at.x < part.x1 && at.y >= part.y0 && at.y < part.y1;
    return shown && !HasSettled(*c, pixel);
  }));
}

}  // namespace nacre
