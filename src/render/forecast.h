// SPDX-License-Identifier: Apache-2.0
// render/forecast.h: estimates what it takes to render a picture to a given error, beforehand.
#pragma once

#include <optional>

#include "render/frame_plan.h"

namespace nacre {

struct Forecast {
  double samples_per_pixel;
  double unsettled_share;  // of the pixels
  double seconds;          // of rendering
};

// Renders at most one in 64 cells of adaptive sampling, spread over the window, and scales their
// cost to all cells. Returns nullopt for plans without adaptive sampling, and for windows with too
// few cells for an estimate. Throws Cancelled.
std::optional<Forecast> ForecastRender(const FramePlan& plan, const RenderSettings& settings);

}  // namespace nacre
