// SPDX-License-Identifier: Apache-2.0
// render/rare_features.h: finds rare features, which only few samples of a pixel hit, before the
// pixel's first sample. These are spheres, triangles (rare_triangles.cc), texels (rare_texels.cc)
// and highlights (glints.h, mesh_glints.h) that are smaller than a pixel.
#pragma once

#include <vector>

#include "render/evidence.h"

namespace nacre {

// Reads the cell's spheres, work->shapes.spheres. Traces rays to measure the radiance of highlights
// and triangles.
void FindRareFeatures(const FramePlan& plan, const Window& cell, const CellDust& dust,
                      TileWork* work, KnownFeatures* known);

// Adds rare triangles to `parts`.
void FindRareTriangles(const FramePlan& plan, const Window& cell, TileWork* work,
                       std::vector<RarePart>* parts);
// Adds rare texels to known->parts, and sets has_other_texels.
void FindRareTexels(const FramePlan& plan, const Window& cell, TileWork* work,
                    KnownFeatures* known);

}  // namespace nacre
