// SPDX-License-Identifier: Apache-2.0
// render/glints.h: where spheres show the highlights of small lights, and how large these are on
// the film: known from the geometry, before any sample.
#pragma once

#include <vector>

#include "render/frame_plan.h"

namespace nacre {

// A highlight on a sphere, in pixels of the frame.
struct Glint {
  uint32_t primitive;
  uint32_t material;
  size_t light;  // punctual ones first, then those with an extent, as in the plan
  double x, y;   // where its peak lies
  double area;   // of a disk as bright as the peak that has all of the highlight's flux
  // From the peak a step on the film to the sphere's centre that is four times the highlight's
  // half-width, or the whole way if that is less: to what is seen beside it.
  double beside_x, beside_y;
};

// Adds the sphere's highlights, of every light that it has one of, whose areas are less than
// `largest` pixels. Shadows and what may hide them are not looked for. Lights with an extent count
// as spheres around them. None on materials without a lobe, nor where the camera or the light is
// inside the sphere.
void AddGlints(const FramePlan& plan, const Projector& projector, const TileCandidate& candidate,
               double largest, std::vector<Glint>* glints);

}  // namespace nacre
