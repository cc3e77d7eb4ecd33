// SPDX-License-Identifier: Apache-2.0
// cli/plot_defaults.h: what `nacre plot` draws unless it is told what: materials and lights that
// show what each kind of plot is for.
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
