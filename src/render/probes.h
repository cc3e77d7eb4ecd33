// SPDX-License-Identifier: Apache-2.0
// render/probes.h: the radiance at single places of the film, which adaptive sampling looks at
// before a cell's first sample.
#pragma once

#include "render/tile_work.h"

namespace nacre {

struct Probe {
  double x, y;    // on the film, in pixels
  uint32_t seed;  // of its samples of lights
  uint32_t hit = kNoPrimitive;
  Rgb radiance{0, 0, 0};
};

// Sets `hit` and `radiance` of the probes, which lie within the reach of the tile's samples, or in
// a pixel that this ends in: there, spheres of the tile next to it alone are not seen.
void TraceProbes(const FramePlan& plan, std::vector<Probe>* probes, TileWork* work,
                 StageClock* clock, RenderStats* stats);

}  // namespace nacre
