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
// The reason why all rays use a BVH with this choice, whatever the scene; else null.
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
  // Adaptive sampling (adaptive.h) if max_error is above 0: the largest error of a pixel relative
  // to max(|L|, 0.05), or for highlights relative to white (white_level.h). max_samples is
  // approximately the largest number of samples of a pixel. If max_error is 0, every pixel takes
  // the scene's samples.
  double max_error = 0;
  int max_samples = 4096;
  // Whether diffuse reflection of lights with an extent is computed in closed form where possible.
  // false: only by samples, for tests that compare the two.
  bool closed_forms = true;
  // Whether distant lights are located relative to hits on spheres from the hits' normals
  // (ShadingLight::from_spheres). false: always from the hits' positions, for tests.
  bool far_lights = true;
  // Whether the layer of a light shows only its diffuse reflection, not its specular one as well,
  // if both components are computed: for code that explains a pixel.
  bool diffuse_light_layers = false;
  // Whether to take none of the shortcuts that change no bits: shadow rays are traced even where
  // nothing can occlude them, every sample gets a position and is summed. For tests that compare
  // shortcuts with the general path.
  bool general_path = false;
  // Whether to measure how long each stage takes (RenderStats::stage_seconds). This costs some per
  // cent of the time of small frames. Output is always measured.
  bool time_stages = false;
  // Setting it to true, from any thread, ends the render: Cancelled is thrown within milliseconds
  // or, while the plan is made, at the end of the current step. May be null.
  CancelPointer cancel = nullptr;
  // Called after every strip, from any thread, one call at a time, with the share of the work that
  // is done, in (0, 1]. An exception from it ends the render.
  std::function<void(double)> on_progress;
  // Called in the same way while the plan is made, between its large steps.
  std::function<void(double)> on_plan_progress;
};

}  // namespace nacre
