// SPDX-License-Identifier: Apache-2.0
// render/dust.h: handles pixels in which small spheres and thin triangles cover little of the
// background, and nothing else is in front of it. Samples of the whole pixel would seldom hit them.
// So samples are restricted to patches that contain the shapes' projections: the rest of the pixel
// is known to be background.
//
// For a random point in one of the patches, which is chosen with a probability proportional to its
// area, the value
//   background + share / patches * (radiance - background)
// has the pixel as its mean, where `share` is the sum of the patches' areas as shares of the pixel
// and `patches` is the number of patches that the point lies in.
#pragma once

#include <span>

#include "render/cell_state.h"

namespace nacre {

// Finds these pixels and their patches, for box filters in front of a background of one colour.
// Must be called before a cell's first sample.
void FindDust(const FramePlan& plan, const Window& cell, const TileShapes& shapes,
              CellState* cell_scratch);

// Moves samples of such pixels into their patches. `film` has `count` samples of each entry of the
// list, one entry after the other.
void MoveToDust(const FramePlan& plan, const Window& cell,
                std::span<const CellState::SampleEntry> list, size_t count, FilmBatch* film,
                CellState* cell_scratch);

// Replaces the values of such samples by the value given above.
void WeighDust(double background, std::span<const CellState::SampleEntry> list, size_t count,
               const CellState& cell_scratch, double* values);

}  // namespace nacre
