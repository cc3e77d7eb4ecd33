// SPDX-License-Identifier: Apache-2.0
#include "render/outline_pixels.h"

#include <algorithm>
#include <limits>

#include "render/outline_coverage.h"

namespace nacre {
namespace {

// Marks a pixel that an outline may cross, and computes its coverage if it shows one outline only.
void FindCoverage(const FramePlan& plan, const VisibleOutlines& seen, uint32_t pixel, double x,
                  double y, OutlinePixels* outlines) {
  const double half_side = plan.adaptive.box_half_side;
  double covered = -1;
  if (seen.only_sphere != nullptr && half_side > 0) {
    const OutlineForm outline = MakeOutlineForm(plan.camera, *seen.only_sphere, x, y);
    if (IsGentlyCurved(outline)) covered = CoveredShare(outline, half_side);
    if (covered > 0 && covered < 1) {
      const Vec2d step = OffsetIntoCovered(outline, half_side);
      outlines->covered_points.push_back({pixel, x + step.x, y + step.y});
    }
  }
  if (covered == 0 || covered == 1) return;  // the outline passes beside the pixel
  outlines->on_outline[pixel] = true;
  outlines->sees_background[pixel] = seen.background;
  outlines->coverage[pixel] = covered;
  outlines->blocks |= 1u << pixel / kBlockPixels;
}

}  // namespace

void FindOutlinePixels(const FramePlan& plan, const Window& cell, std::span<const uint32_t> pixels,
                       const CellProjections& projections, const CellDust& dust,
                       OutlinePixels* outlines) {
  outlines->blocks = 0;
  outlines->covered_points.clear();
  std::fill_n(outlines->on_outline, kCellPixels, false);
  std::fill_n(outlines->coverage, kCellPixels, -1.0);
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::fill_n(&outlines->hit_low[0][0], 3 * kCellPixels, kInfinity);
  std::fill_n(&outlines->hit_high[0][0], 3 * kCellPixels, -kInfinity);
  if (!projections) return;
  const double filter_radius = plan.adaptive.filter_radius;
  for (const uint32_t i : pixels) {
    if (dust.sampled_share[i] < 1) continue;
    const FilmPixel pixel = PixelOf(cell, i);
    const double x = pixel.x + 0.5, y = pixel.y + 0.5;
    const VisibleOutlines seen =
        FindVisibleOutlines(plan.camera, *projections, x, y, filter_radius);
    if (seen.any) FindCoverage(plan, seen, i, x, y, outlines);
  }
}

void FindHitRanges(std::span<const uint32_t> pixels, OutlinePixels* outlines) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (size_t channel = 0; channel < 3; ++channel) {
    std::fill_n(outlines->hit_range[channel], kCellBlocks, PixelRange{kInfinity, -kInfinity});
    for (const uint32_t pixel : pixels) {
      if (!outlines->on_outline[pixel]) continue;
      PixelRange& range = outlines->hit_range[channel][pixel / kBlockPixels];
      range.low = std::min(range.low, outlines->hit_low[channel][pixel]);
      range.high = std::max(range.high, outlines->hit_high[channel][pixel]);
    }
  }
}

}  // namespace nacre
