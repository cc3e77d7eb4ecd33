// SPDX-License-Identifier: Apache-2.0
// cli/plot_defaults.h: what `nacre plot` draws by default: materials and lights that show the
// purpose of each kind of plot.
#pragma once

#include <vector>

#include "cli/plot_inputs.h"

namespace nacre {

std::vector<PlotItem> DefaultModels();
std::vector<PlotItem> DefaultDistributions();
std::vector<PlotItem> DefaultMaskings();
std::vector<PlotItem> DefaultAlbedos();
std::vector<PlotItem> DefaultInterfaces();
std::vector<PlotItem> DefaultLights();

}  // namespace nacre
