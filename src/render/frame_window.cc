// SPDX-License-Identifier: Apache-2.0
#include "render/frame_window.h"

#include <algorithm>
#include <cstdint>

#include <fmt/format.h>

#include "base/error.h"

namespace nacre {
namespace {

Window RegionWindow(const Window& frame, const Window& region) {
  const Window window = Intersect(frame, region);
  if (window.empty()) {
    throw Error(ExitCode::kUsage, "--region",
                fmt::format("{},{},{},{} holds no pixel of the {}x{} frame", region.x0, region.y0,
                            region.x1, region.y1, frame.x1, frame.y1),
                "give x0,y0,x1,y1 in pixels from the top left, x1 and y1 not included");
  }
  return window;
}

// A unit is `band_rows` rows. Bands differ by at most one unit, and none is empty.
Window BandWindow(const Window& frame, const FrameBand& band, int band_rows) {
  const int units = MaxBands(frame, band_rows);
  if (band.count > units) {
    throw Error(ExitCode::kUsage, "--tile",
                fmt::format("{}/{}: a frame of {} rows has {} bands of {} rows at most", band.index,
                            band.count, frame.height(), units, band_rows),
                fmt::format("give N up to {}", units));
  }
  const auto top = [&](int index) {
    const int64_t unit = int64_t{index} * units / band.count;
    return frame.y0 + static_cast<int>(unit) * band_rows;
  };
  return {frame.x0, top(band.index), frame.x1, std::min(top(band.index + 1), frame.y1)};
}

}  // namespace

int MaxBands(const Window& frame, int band_rows) {
  return (frame.height() + band_rows - 1) / band_rows;
}

Window FrameWindow(const Window& frame, const RenderSettings& settings) {
  if (settings.band.count > 0) return BandWindow(frame, settings.band, settings.band_rows);
  return settings.region == Window{} ? frame : RegionWindow(frame, settings.region);
}

}  // namespace nacre
