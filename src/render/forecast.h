// SPDX-License-Identifier: Apache-2.0
// render/forecast.h: what a picture to a wanted error will take, told before it is rendered.
#pragma once

#include <optional>

#include "render/frame_plan.h"

namespace nacre {

struct Forecast {
  double samples_per_pixel;
  double unsettled_share;  // of the pixels
  double seconds;          // of rendering
};

// Renders at most one in 64 cells of adaptive sampling, spread over the window, and scales what
// they took to all of them. None for plans without adaptive sampling, and for windows of so few
// cells that these would tell little. Throws Cancelled.
std::optional<Forecast> ForecastRender(const FramePlan& plan, const RenderSettings& settings);

}  // namespace nacre
