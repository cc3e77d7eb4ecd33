// SPDX-License-Identifier: Apache-2.0
// cli/lighting.h: the lights of sheets, chosen by the name of a set-up or given as JSON.
#pragma once

#include <string>
#include <vector>

#include <CLI/App.hpp>

#include "scene_io/json_text.h"

namespace nacre {

struct LightingOptions {
  std::string light = "point";  // name of a set-up
  std::string lights;           // JSON, or the path of a file that holds it
  std::string environment;      // path of an image
  std::string background;       // a colour; empty: that of the set-up
};

// Adds --light, --lights, --environment and --background.
void AddLightingOptions(CLI::App* command, LightingOptions* options);

// The files that the options name.
std::vector<std::string> InputFiles(const LightingOptions& options);

// What MakeLighting makes of the options, for a scene whose shapes lie within `reach` of the origin
// in the plane z = 0 and are seen from +z. `centred`: the highlight of the set-up "point" is on the
// vertical middle line.
struct Lighting {
  Json lights = Json::object();
  Json background;       // a colour
  bool sampled = false;  // some light has an extent, so that the picture has noise
  std::string label;     // "light: studio"
};

// Throws Error for invalid lights.
Lighting MakeLighting(const LightingOptions& options, double reach, bool centred = false);

}  // namespace nacre
