// SPDX-License-Identifier: Apache-2.0
// render/rare_triangles.h: finds those of a cell's small triangles (small_triangles.h) that are
// rare features of its pixels, and measures their radiance.
//
// In a finely tessellated mesh all triangles are small and none is rare. Where triangles of one
// material and side cover half of a pixel, or as much of the 3x3 pixels around it as the edge of a
// large object would, samples find them like any large object. The others are probed by a ray
// through the middle of each: hidden ones do not count, and those that look like their surroundings
// do not matter (evidence.h).
#pragma once

#include "render/evidence.h"

namespace nacre {

// Adds rare triangles to `parts`.
void FindRareTriangles(const FramePlan& plan, const Window& cell, TileWork* work,
                       std::vector<RarePart>* parts);

}  // namespace nacre
