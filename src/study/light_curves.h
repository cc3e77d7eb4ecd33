// SPDX-License-Identifier: Apache-2.0
// study/light_curves.h: curves of light fall-off and of tone operators.
#pragma once

#include <optional>

#include "report/plot.h"
#include "scene/light.h"

namespace nacre {

// The irradiance, as a luminance, on a surface that faces the light, at this distance from its
// position or centre along its axis. nullopt inside a sphere light, and for lights all around or
// without an axis.
std::optional<double> IrradianceAt(const Light& light, double distance);

// Whether IrradianceAt supports the light.
bool HasFalloff(const Light& light);

// Irradiance over distance, with logarithmic axes.
Plot FalloffPlot(const std::vector<Light>& lights);

// The displayed value (encoded, 1 is white) over the radiance of a grey, for each operator.
Plot TonePlot(double exposure_ev);

}  // namespace nacre
