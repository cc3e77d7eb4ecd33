// SPDX-License-Identifier: Apache-2.0
// study/light_curves.h: lights over distance, and tone operators, as curves.
#pragma once

#include <optional>

#include "report/plot.h"
#include "scene/light.h"

namespace nacre {

// The irradiance, as a luminance, of a surface that faces the light, at this distance from its
// position or centre along its axis. Nothing inside a sphere light, and for lights that are all
// around.
std::optional<double> IrradianceAt(const Light& light, double distance);

// Lights that IrradianceAt knows.
bool HasFalloff(const Light& light);

// Irradiance over distance, both logarithmic.
Plot FalloffPlot(const std::vector<Light>& lights);

// What a display shows (encoded, 1 is white) over the radiance of a grey, for every operator.
Plot TonePlot(double exposure_ev);

}  // namespace nacre
