// SPDX-License-Identifier: Apache-2.0
// render/dust.h: pixels in which small spheres and thin triangles cover little of the background,
// and nothing else is before it. Samples spread over the whole pixel would seldom hit them. So they
// are spread over patches alone that hold the shapes' projections: all else of the pixel is the
// background, and known.
//
// For a point at random in one of the patches, which is chosen with a probability proportional to
// its area, the value
//   background + share / patches * (radiance - background)
// has the pixel as its mean, `share` being the sum of the patches' areas as shares of the pixel and
// `patches` how many of them the point lies in.
#pragma once

#include <span>

#include "render/cell_state.h"

namespace nacre {

// Finds these pixels and their patches, for box filters before a background of one colour. To be
// called before a cell's first sample.
void FindDust(const FramePlan& plan, const Window& cell, const TileShapes& shapes,
              CellState* cell_scratch);

// Moves samples of such pixels into their patches. `film` has `count` samples of each entry of the
// list, one entry after the other.
void MoveToDust(const FramePlan& plan, const Window& cell,
                std::span<const CellState::SampleEntry> list, size_t count, FilmBatch* film,
                CellState* cell_scratch);

// Replaces the values of such samples by those given above.
void WeighDust(double background, std::span<const CellState::SampleEntry> list, size_t count,
               const CellState& cell_scratch, double* values);

}  // namespace nacre
