// SPDX-License-Identifier: Apache-2.0
// render/glints.h: where spheres show the highlights of small lights, and how large these are on
// the film: known from the geometry, before any sample.
#pragma once

#include <vector>

#include "render/frame_plan.h"

namespace nacre {

// Adds the sphere's highlights, of every light that it has one of, whose areas are less than
// `largest` pixels. Shadows and what may hide them are not looked for. Lights with an extent count
// as spheres around them. None on materials without a lobe, nor where the camera or the light is
// inside the sphere.
void AddGlints(const FramePlan& plan, const Projector& projector, const TileCandidate& candidate,
               double largest, std::vector<Glint>* glints);

}  // namespace nacre
