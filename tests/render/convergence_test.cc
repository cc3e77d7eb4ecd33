// SPDX-License-Identifier: Apache-2.0
// tests/render/convergence_test.cc: which pixels are told as not settled.
#include "render/convergence.h"

#include <algorithm>
#include <memory>

#include "catch.h"
#include "render/frame_plan.h"

namespace nacre {
namespace {

// One pixel on an outline, half covered, with one sample in each replicate: the first two hit what
// shines with 0.6, the others a black background. Other hits of the pixel's block shine with `low`
// to `high`.
size_t CountUnsettledOf(double low, double high, size_t levels) {
  FramePlan plan;
  plan.film.layers.resize(1);
  plan.adaptive.max_error = 0.1;
  plan.adaptive.sampling.levels.resize(levels);
  const auto cell = std::make_unique<CellState>();
  cell->active = {0};
  cell->samples.count[0] = 1;
  for (size_t r = 0; r < 2; ++r) {
    for (size_t channel = 0; channel < 3; ++channel) cell->samples.sums[r][channel][0] = 0.6;
    cell->samples.sums[r][3][0] = 1;
  }
  std::fill_n(cell->dust.sampled_share, kCellPixels, 1.0);
  cell->outlines.blocks = 1;
  cell->outlines.on_outline[0] = cell->outlines.sees_background[0] = true;
  cell->outlines.coverage[0] = 0.5;
  for (size_t channel = 0; channel < 3; ++channel) {
    cell->outlines.hit_low[channel][0] = low;
    cell->outlines.hit_high[channel][0] = high;
    cell->evidence.second_highest[channel][0] = cell->evidence.highest[channel][0] = 0.6;
  }
  const Window window{0, 0, kCellSize, kCellSize};
  return CountUnsettled(plan, window, window, cell.get());
}

// With so few samples that no pixel was ever dropped, a block's range was never found before: the
// error of an outline pixel is its coverage times the range, over its two hits.
TEST_CASE("a pixel settles when each of its channels has") {
  FramePlan plan;
  plan.film.layers.resize(1);
  plan.adaptive.max_error = 0.1;
  plan.adaptive.white = 1;
  plan.adaptive.sampling.levels.resize(kCommonLevels);
  const Window window{0, 0, kCellSize, kCellSize};
  // The replicates agree in all channels but this one, if it is one.
  for (size_t differing = 0; differing <= 3; ++differing) {
    const auto cell = std::make_unique<CellState>();
    cell->active = {0};
    cell->samples.count[0] = 64;
    std::fill_n(cell->dust.sampled_share, kCellPixels, 1.0);
    for (size_t r = 0; r < kReplicates; ++r) {
      for (size_t channel = 0; channel < 3; ++channel) {
        const bool differs = channel == differing && r % 2 != 0;
        cell->samples.sums[r][channel][0] = differs ? 64 * 0.75 : 64 * 0.5;
      }
    }
    CAPTURE(differing);
    CHECK(CountUnsettled(plan, window, window, cell.get()) == (differing < 3 ? 1 : 0));
  }
}

TEST_CASE("outline pixels of few samples are told by the range of their block's hits") {
  CHECK(CountUnsettledOf(0.6, 0.6, 1) == 0);
  CHECK(CountUnsettledOf(0.55, 0.65, 1) == 0);  // 0.025 of 0.3
  CHECK(CountUnsettledOf(0.2, 1, 1) == 1);      // 0.2 of 0.3
}

}  // namespace
}  // namespace nacre
