// SPDX-License-Identifier: Apache-2.0
// render/glints.h: the position and the size on the film of the highlights that small lights cause
// on spheres. They follow from the geometry, without any sample.
#pragma once

#include <vector>

#include "render/frame_plan.h"

namespace nacre {

// Adds the sphere's highlights whose area on the film is less than `max_area` pixels, one per light
// at most. Lights with an extent count as their bounding balls. There are none on materials without
// a lobe, nor if the camera or the light is inside the sphere. Occlusion is ignored: other shapes
// may shadow or hide a highlight.
void AddGlints(const FramePlan& plan, const Projector& projector, const TileCandidate& candidate,
               double max_area, std::vector<Glint>* glints);

}  // namespace nacre
