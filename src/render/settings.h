// SPDX-License-Identifier: Apache-2.0
// render/settings.h: the settings of a render that are not part of its scene.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "base/cancel.h"
#include "base/image.h"
#include "base/strip.h"

namespace nacre {

// How rays find spheres. All choices give the same bits.
enum class IntersectorChoice : uint8_t { kAuto, kEmbree, kTiles, kShells };

// "auto", "embree", "tiles", "shells".
std::vector<std::string> IntersectorNames();
// Throws Error (usage) for a name that is none of these, and for Embree where this build has none.
IntersectorChoice ParseIntersector(const std::string& name);
// Why all rays use a tree with this choice, whatever the scene; else null.
const char* TreeAskedFor(IntersectorChoice choice);

// One of `count` horizontal bands that together hold every row of the frame once (--tile).
struct FrameBand {
  int index = 0;
  int count = 0;  // 0: the frame is not cut
};

struct RenderSettings {
  int threads = 0;                  // 0: as many as the machine has
  Window region;                    // pixels to render; empty: the whole frame
  FrameBand band;                   // if its count is above 0: the pixels to render, not `region`
  int band_rows = kStripRows;       // bands begin at multiples of this; a multiple of kStripRows
  std::vector<std::string> layers;  // besides R G B A; names as in render/layers.h
  int tile_size = 0;  // width of tiles in pixels, [1, 64]; 0: the plan chooses. Changes no bit
  IntersectorChoice intersector = IntersectorChoice::kAuto;
  // Adaptive sampling (adaptive.h) if above 0: the largest error of a pixel relative to max(|L|,
  // 0.05), or for highlights relative to white (white_level.h); and approximately the largest
  // number of samples of a pixel. 0: every pixel takes the scene's samples.
  double max_error = 0;
  int max_samples = 4096;
  // Compute diffuse reflection of lights with an extent in closed form where possible. false: only
  // by samples, for tests that compare the two.
  bool closed_forms = true;
  // Locate distant lights relative to hits on spheres from the hits' normals
  // (ShadingLight::from_spheres). false: always from the hits' positions, for tests.
  bool far_lights = true;
  // The layer of a light shows its diffuse reflection alone, and not its specular one as well: with
  // both components among the layers, for whoever explains a pixel.
  bool diffuse_light_layers = false;
  // Take none of the shortcuts that change no bits: shadow rays are traced even where nothing can
  // occlude them, every sample gets a position and is summed. For tests that compare shortcuts with
  // the general path.
  bool general_path = false;
  // Measure how long each stage takes (RenderStats::stage_seconds). Costs some per cent of the time
  // of small frames. Output is always measured.
  bool time_stages = false;
  // Setting it to true, from any thread, ends the render: Cancelled is thrown within milliseconds,
  // or while the plan is made at the end of one of its steps. May be null.
  CancelPointer cancel = nullptr;
  // Called after every strip, from any thread, one call at a time, with the share of the work that
  // is done, in (0, 1]. An exception from it ends the render.
  std::function<void(double)> on_progress;
  // Called in the same way while the plan is made, between its large steps.
  std::function<void(double)> on_plan_progress;
};

}  // namespace nacre
