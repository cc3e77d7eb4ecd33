// SPDX-License-Identifier: Apache-2.0
// render/probes.h: measures the radiance at single points of the film, for adaptive sampling before
// a cell's first sample.
#pragma once

#include "render/tile_work.h"

namespace nacre {

struct Probe {
  double x, y;        // on the film, in pixels
  uint32_t seed = 0;  // of its light samples
  uint32_t hit = kNoPrimitive;
  Rgb radiance{0, 0, 0};
};

// Sets `hit` and `radiance` of the probes. They must lie where samples of the tile may lie, or in a
// pixel in which that range ends: there, spheres that only the neighbouring tile lists are not hit.
// If lights are sampled, a probe takes the mean of several samples; if `alike`, all probes take one
// sample with the same random numbers instead, so that their differences are not noisy.
void TraceProbes(const FramePlan& plan, bool alike, std::vector<Probe>* probes, TileWork* work);

}  // namespace nacre
