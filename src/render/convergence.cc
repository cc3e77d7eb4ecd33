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

// A peak narrower than a pixel may lie between the pixel's samples while its neighbours' samples
// hit the flanks. So a pixel stays active while a neighbour has an interval that is wider than this
// many times the pixel's own tolerance.
constexpr double kNeighbourSlack = 8;

// How many levels a block takes before it may stop: 16 samples a pixel with most filters, because
// four samples miss an edge that cuts off the corner of a pixel too often. One level less, that is,
// half of the samples, is enough where the only edges are outlines, whose pixels are known.
size_t CommonLevels(const CellState& c, size_t block) {
  return kCommonLevels - ((c.only_outlines & c.outlined) >> block & 1);
}

// The range of the samples that hit, over the outline pixels of each block.
void FindOutlineRanges(CellState* c) {
  for (size_t channel = 0; channel < 3; ++channel) {
    std::fill_n(c->outline_range[channel], kCellBlocks, PixelRange{kUnbounded, -kUnbounded});
    for (const uint32_t pixel : c->active) {
      if (!c->on_outline[pixel]) continue;
      PixelRange& range = c->outline_range[channel][pixel / kBlockPixels];
      range.low = std::min(range.low, c->hit_low[channel][pixel]);
      range.high = std::max(range.high, c->hit_high[channel][pixel]);
    }
  }
}

// The interval of an outline pixel in one channel of the beauty.
Interval MeasureOutlineChannel(const CellState& c, uint32_t pixel, int channel, double background) {
  const double scale = 1.0 / c.samples[pixel], samples = double{kReplicates} * c.samples[pixel];
  double values[kReplicates];
  for (size_t r = 0; r < kReplicates; ++r) values[r] = c.replicate[r][channel][pixel] * scale;
  const PixelRange& range = c.outline_range[channel][pixel / kBlockPixels];
  if (c.coverage[pixel] < 0) {
    return MeasureOnOutline(values, range, c.sees_background[pixel] ? &background : nullptr,
                            samples);
  }
  double hits[kReplicates];
  for (size_t r = 0; r < kReplicates; ++r) hits[r] = c.replicate[r][kAlphaSum][pixel] * scale;
  return MeasureCovered(values, hits, c.coverage[pixel], range, background, samples);
}

// Copies the interval of one pixel.
void CopyInterval(const BlockIntervals& from, uint32_t i, BlockIntervals* to) {
  to->narrow = (to->narrow & ~(1u << i)) | (from.narrow & 1u << i);
  to->half_width[i] = from.half_width[i];
  to->tolerance[i] = from.tolerance[i];
}

// The interval and the tolerance of an outline pixel. Written so that NaN never converges; NaN is
// counted and reported where the picture is written.
void MeasureOutlinePixel(const ErrorBound& error, const Rgb& background, uint32_t pixel,
                         CellState* c) {
  BlockIntervals& intervals = c->intervals[pixel / kBlockPixels];
  const size_t i = pixel % kBlockPixels;
  double widest = 0, strictest = kUnbounded;
  bool narrow = true;
  for (int channel = 0; channel < 3; ++channel) {
    const Interval interval = MeasureOutlineChannel(*c, pixel, channel, background[channel]);
    const double tolerance = ToleranceAt(error, interval.mean);
    narrow = narrow && interval.half_width2 <= tolerance * tolerance;
    widest = std::max(widest, interval.half_width2);
    strictest = std::min(strictest, tolerance);
  }
  intervals.tolerance[i] = strictest;
  intervals.half_width[i] = std::sqrt(widest);
  intervals.narrow = (intervals.narrow & ~(1u << i)) | uint32_t{narrow} << i;
}

// Measures a block's pixels. Outline pixels that are no longer active keep their intervals.
void MeasureBlockOfCell(const ErrorBound& error, const Rgb& background, size_t block,
                        uint32_t active, CellState* c) {
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
      MeasureOutlinePixel(error, background, first + i, c);
    } else {
      CopyInterval(before, i, &c->intervals[block]);
    }
  }
}

void MeasureActive(const ErrorBound& error, const Rgb& background, CellState* c) {
  uint32_t active[kCellBlocks] = {};  // pixels, as bits
  for (const uint32_t pixel : c->active) active[pixel / kBlockPixels] |= 1u << pixel % kBlockPixels;
  for (size_t block = 0; block < kCellBlocks; ++block) {
    if (active[block] != 0) MeasureBlockOfCell(error, background, block, active[block], c);
  }
}

bool IsWithinTolerance(const CellState& c, uint32_t pixel) {
  return (c.intervals[pixel / kBlockPixels].narrow >> pixel % kBlockPixels & 1) != 0;
}

// Marks a pixel that an outline may cross, and computes its coverage if it shows one outline only.
void FindCoverage(const FramePlan& plan, const VisibleOutlines& seen, uint32_t pixel, double x,
                  double y, CellState* c) {
  const double half_side = plan.adaptive.box_half_side;
  double covered = -1;
  if (seen.only_sphere != nullptr && half_side > 0) {
    const OutlineForm outline = MakeOutlineForm(plan.camera, *seen.only_sphere, x, y);
    if (IsGentlyCurved(outline)) covered = CoveredShare(outline, half_side);
    if (covered > 0 && covered < 1) {
      const FilmOffset step = OffsetIntoCovered(outline, half_side);
      c->covered_points.push_back({pixel, x + step.dx, y + step.dy});
    }
  }
  if (covered == 0 || covered == 1) return;  // the outline passes beside the pixel
  c->on_outline[pixel] = true;
  c->sees_background[pixel] = seen.background;
  c->coverage[pixel] = covered;
  c->outlined |= 1u << pixel / kBlockPixels;
}

// The largest half-width among the neighbours in the block that are not within their tolerance.
double WidestNeighbour(const CellState& c, uint32_t pixel) {
  const BlockIntervals& intervals = c.intervals[pixel / kBlockPixels];
  const int x = static_cast<int>(pixel % kBlockSide);
  const int y = static_cast<int>(pixel % kBlockPixels) / kBlockSide;
  double widest = 0;
  for (int row = std::max(y - 1, 0); row <= std::min(y + 1, kBlockSide - 1); ++row) {
    for (int column = std::max(x - 1, 0); column <= std::min(x + 1, kBlockSide - 1); ++column) {
      const auto i = static_cast<uint32_t>(row * kBlockSide + column);
      if ((intervals.narrow >> i & 1) != 0) continue;
      // Rare features are known for each pixel by itself, and say nothing about its neighbours.
      const uint32_t other = pixel - pixel % uint32_t{kBlockPixels} + i;
      if (c.required_samples[other] > 0) continue;
      widest = std::max(widest, intervals.half_width[i]);
    }
  }
  return widest;
}

bool HasConverged(const CellState& c, uint32_t pixel) {
  if (c.sampled_share[pixel] == 0) return true;  // it is the background
  const double tolerance = c.intervals[pixel / kBlockPixels].tolerance[pixel % kBlockPixels];
  return IsWithinTolerance(c, pixel) && WidestNeighbour(c, pixel) <= kNeighbourSlack * tolerance;
}

}  // namespace

void FindOutlinePixels(const FramePlan& plan, const Window& cell, CellState* c) {
  c->outlined = 0;
  c->covered_points.clear();
  std::fill_n(c->on_outline, kCellPixels, false);
  std::fill_n(c->coverage, kCellPixels, -1.0);
  std::fill_n(&c->hit_low[0][0], 3 * kCellPixels, kUnbounded);
  std::fill_n(&c->hit_high[0][0], 3 * kCellPixels, -kUnbounded);
  if (!c->projections) return;
  const double filter_radius = plan.adaptive.filter_radius;
  for (const uint32_t i : c->active) {
    if (c->sampled_share[i] < 1) continue;
    const FilmPixel pixel = PixelOf(cell, i);
    const double x = pixel.x + 0.5, y = pixel.y + 0.5;
    const VisibleOutlines seen =
        FindVisibleOutlines(plan.camera, *c->projections, x, y, filter_radius);
    if (seen.any) FindCoverage(plan, seen, i, x, y, c);
  }
}

void DropConverged(const FramePlan& plan, size_t level, CellState* c) {
  if (level + 2 < kCommonLevels) return;
  if (level + 2 == kCommonLevels) FindOutlineRanges(c);
  const Rgb background = BackgroundOf(plan.film.layers[0], plan.film);  // the beauty's
  MeasureActive({plan.adaptive.max_error, plan.adaptive.white}, background, c);
  RequireEvidence(c);
  uint32_t open = 0;  // blocks, as bits, with pixels beyond their tolerance
  for (const uint32_t pixel : c->active) {
    if (!IsWithinTolerance(*c, pixel)) open |= 1u << pixel / kBlockPixels;
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
  if (plan.adaptive.levels.size() + 1 < kCommonLevels) FindOutlineRanges(c);
  MeasureActive({plan.adaptive.max_error, kUnbounded}, BackgroundOf(plan.film.layers[0], plan.film),
                c);
  RequireEvidence(c);
  return static_cast<size_t>(std::count_if(c->active.begin(), c->active.end(), [&](uint32_t pixel) {
    const FilmPixel at = PixelOf(cell, pixel);
    const bool shown = at.x >= part.x0 && at.x < part.x1 && at.y >= part.y0 && at.y < part.y1;
    return shown && !HasConverged(*c, pixel);
  }));
}

}  // namespace nacre
