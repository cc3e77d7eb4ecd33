// SPDX-License-Identifier: Apache-2.0
// render/footprint.h: finds the blocks of pixels that need only one sample per pixel.
#pragma once

#include "render/cell.h"

namespace nacre {

// Blocks, as bits.
struct BlockEdges {
  // Have no edge: with the filter's radius around them they lie wholly on one sphere or beside all
  // spheres.
  uint32_t none = 0;
  uint32_t only_outlines = 0;  // have no edges but outlines of spheres
};

// Finds the edges of `blocks` among the cell's spheres, work->shapes.spheres. Traces rays through
// the corners of blocks, before the cell's first sample.
BlockEdges FindEdges(const FramePlan& plan, const Window& cell, uint32_t blocks,
                     const CellProjections& projections, TileWork* work);

// Whether, in a block without edges, the values at the centres of the pixels are within the
// tolerance of the pixels' means: second differences are small, and no lobe is so narrow that it
// may lie between the centres. `first_ray` is the first of the block's rays in work->samples,
// `values` is the beauty by ray, and `hit_of_ray` is the index of each ray's hit, or kNoHit.
inline constexpr uint32_t kNoHit = 0xffffffffu;
bool IsSmooth(const FramePlan& plan, size_t first_ray, const Soa3<double>& values,
              const uint32_t* hit_of_ray, const TileWork& work);

}  // namespace nacre
