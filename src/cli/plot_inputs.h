// SPDX-License-Identifier: Apache-2.0
// cli/plot_inputs.h: the materials and lights that `nacre plot` draws.
#pragma once

#include <string>
#include <vector>

#include "scene/light.h"
#include "study/material_curves.h"

namespace nacre {

struct PlotInputs {
  std::string scene;  // a scene file or model; empty: none
  bool allow_paths = false;
  std::vector<std::string> outputs;    // files to be written, which must not be files of the scene
  std::vector<std::string> materials;  // names in the scene, models' names, or JSON
  std::vector<std::string> lights;     // names in the scene, or JSON
};

// A material or light, with its label in a plot's legend.
struct PlotItem {
  std::string label;
  std::string text;  // as given in an option
};

// The materials that the options name; without names, all of the scene, or, if there is no scene,
// `defaults`. Throws Error: kUsage for what is not a material, kBadInput for names that are not in
// the scene and for malformed ones.
std::vector<NamedMaterial> ReadPlotMaterials(const PlotInputs& inputs,
                                             const std::vector<PlotItem>& defaults);

// The lights that the options name, chosen as in ReadPlotMaterials.
std::vector<Light> ReadPlotLights(const PlotInputs& inputs, const std::vector<PlotItem>& defaults);

// What is drawn by default, to show the purpose of each kind of plot.
std::vector<PlotItem> DefaultModels();
std::vector<PlotItem> DefaultDistributions();
std::vector<PlotItem> DefaultMaskings();
std::vector<PlotItem> DefaultAlbedos();
std::vector<PlotItem> DefaultInterfaces();
std::vector<PlotItem> DefaultLights();

}  // namespace nacre
