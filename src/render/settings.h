// SPDX-License-Identifier: Apache-2.0
// render/settings.h: what a render is asked for beyond its scene.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "base/image.h"
#include "base/strip.h"

namespace nacre {

// How rays find spheres. All find the same hits, to the bit.
enum class IntersectorChoice : uint8_t { kAuto, kEmbree, kTiles, kShells };

// "auto", "embree", "tiles", "shells".
std::vector<std::string> IntersectorNames();
// Throws Error (usage) for a name that is none of these, and for Embree where this build has none.
IntersectorChoice ParseIntersector(const std::string& name);
// Why all rays go through a tree, if they do so whatever the scene; or null.
const char* TreeAskedFor(IntersectorChoice choice);

// Thrown by a render that RenderSettings::cancel has ended.
struct Cancelled {};

// One of `count` horizontal bands that together hold every row of the frame once (--tile).
struct FrameBand {
  int index = 0;
  int count = 0;  // 0: the frame is not cut
};

struct RenderSettings {
  int threads = 0;                  // 0: as many as the machine has
  Window region;                    // pixels to render; empty: the whole frame
  FrameBand band;                   // the same by bands; then `region` is not looked at
  int band_rows = kStripRows;       // bands begin at multiples of these; a multiple of kStripRows
  std::vector<std::string> layers;  // besides R G B A; names as in render/layers.h
  int tile_size = 0;  // width of tiles in pixels, [1, 64]; 0: the plan chooses. Changes no bits
  IntersectorChoice intersector = IntersectorChoice::kAuto;
  // Adaptive sampling: the wanted error of a pixel relative to max(|L|, 0.05), above 0, or of a
  // highlight to white (white_level.h), and about how many samples a pixel takes at most. 0: every
  // pixel takes the scene's samples.
  double max_error = 0;
  int max_samples = 4096;
  // Reflect lights with an extent in closed form where that can be; false: only by samples. For
  // tests that hold the two together.
  bool closed_forms = true;
  // Find where far lights lie from the normals of hits on spheres (ShadingLight::from_spheres);
  // false: always from their positions. Likewise.
  bool offsets_by_normal = true;
  // Take no shortcut that changes no bits: shadow rays are traced even where nothing can be in the
  // way, no light is culled, every sample is placed and summed. For tests that hold shortcuts and
  // the general path together.
  bool general_path = false;
  // Measure how long each stage takes (RenderStats::stage_seconds): some per cent of small frames'
  // time. Output is measured always.
  bool time_stages = false;
  // Set from any thread, ends the render: Cancelled is thrown within some milliseconds. Null: never.
  const std::atomic<bool>* cancel = nullptr;
  // Called after every strip, from any thread, one call at a time, with the share done in (0, 1].
  // Throwing from it stops the render.
  std::function<void(double)> on_progress;
  // The same while the plan is made, between its large steps.
  std::function<void(double)> on_plan_progress;
};

}  // namespace nacre
