// SPDX-License-Identifier: Apache-2.0
// cli/plot_inputs.h: the materials and lights that `nacre plot` is told to draw.
#pragma once

#include <string>
#include <vector>

#include "scene/light.h"
#include "study/material_curves.h"

namespace nacre {

struct PlotInputs {
  std::string scene;  // a scene file or model; empty: none
  bool allow_paths = false;
  std::vector<std::string> outputs;    // what is to be written: none of the scene's files may be
  std::vector<std::string> materials;  // names in the scene, models' names, or JSON
  std::vector<std::string> lights;     // names in the scene, or JSON
};

// A material or light, and what a plot's key calls it.
struct PlotItem {
  std::string label;
  std::string text;  // as an option gives it
};

// The materials that the options name; all of the scene's if they name none but a scene; without
// one, `defaults`. Throws Error: kUsage for what is no material, kBadInput for what is not in the
// scene or malformed.
std::vector<NamedMaterial> ReadPlotMaterials(const PlotInputs& inputs,
                                             const std::vector<PlotItem>& defaults);

// The same for lights.
std::vector<Light> ReadPlotLights(const PlotInputs& inputs, const std::vector<PlotItem>& defaults);

}  // namespace nacre
