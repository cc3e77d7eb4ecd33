// SPDX-License-Identifier: Apache-2.0
// tests/render/told_pixels.h: pictures to a wanted error, held to a truth pixel by pixel: which are
// beyond the error, and which are told to be unsettled.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "catch.h"
#include "render/adaptive.h"
#include "render/convergence.h"
#include "render/film.h"
#include "render/render.h"

namespace nacre {

inline constexpr int kSide = 32;  // of the pictures

inline Image Truth(Scene scene, int spp = 4096) {
  scene.image.spp = spp;
  scene.image.seed = 99;
  return RenderImage(scene, {}, nullptr);
}

// The shares of pixels that are beyond the error and not told to be, and of those that are told.
struct Shares {
  double untold = 0, told = 0;
};

// Whether channels are farther from the truth than is wanted.
inline bool IsBeyond(const Image& image, const Image& truth, size_t pixel, double max_error) {
  for (size_t c = 0; c < 3; ++c) {
    const double value = image.channels[c].samples[pixel],
                 wanted = truth.channels[c].samples[pixel];
    if (!(std::abs(value - wanted) <= max_error * std::max(std::abs(wanted), 0.05))) return true;
  }
  return false;
}

// Which pixels are told, row by row: a cell's scratch knows after it is rendered.
inline std::vector<bool> ToldIn(const FramePlan& plan) {
  std::vector<bool> told(plan.frame.pixel_count());
  TileWork work;
  const auto room = std::make_unique<CellRoom>();
  Strip strip;
  StageClock clock(nullptr);
  work.clock = &clock;
  for (int y0 = 0; y0 < kSide; y0 += kCellSize) {
    StartStrip(plan.film, {0, y0, kSide, y0 + kCellSize}, nullptr, &strip);
    for (int x0 = 0; x0 < kSide; x0 += kCellSize) {
      const Window cell{x0, y0, x0 + kCellSize, y0 + kCellSize};
      RenderStats stats;
      work.stats = &stats;
      RenderCell(plan, cell, cell, &work, room.get(), &strip);
      for (const uint32_t pixel : room->state.active) {
        const FilmPixel at = PixelOf(cell, pixel);
        const Window alone{at.x, at.y, at.x + 1, at.y + 1};
        if (CountUnsettled(plan, cell, alone, &room->state) == 0) continue;
        told[static_cast<size_t>(at.y * kSide + at.x)] = true;
      }
    }
  }
  return told;
}

inline Shares SharesOf(const Scene& scene, const Image& truth, double max_error) {
  RenderSettings settings{.max_error = max_error};
  const FramePlan plan = MakePlan(scene, settings);
  RenderStats stats;
  const Image image = RenderImage(plan, settings, &stats);
  const std::vector<bool> told = ToldIn(plan);
  CHECK(static_cast<uint64_t>(std::count(told.begin(), told.end(), true)) ==
        stats.unsettled_pixels);
  Shares shares;
  for (size_t i = 0; i < told.size(); ++i) {
    const bool untold = !told[i] && IsBeyond(image, truth, i, max_error);
    shares.told += told[i] ? 1.0 / (kSide * kSide) : 0;
    shares.untold += untold ? 1.0 / (kSide * kSide) : 0;
  }
  return shares;
}

}  // namespace nacre
