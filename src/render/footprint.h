// SPDX-License-Identifier: Apache-2.0
// render/footprint.h: where one sample a pixel is enough.
#pragma once

#include "render/cell_scratch.h"

namespace nacre {

// Marks, as bits, the blocks of `blocks` (bits) that lie wholly on one sphere or wholly beside all
// of them, by the filter's reach around them: those that may be smooth. Sets
// cell_scratch->outlines_only. `work->sight.spheres` are the cell's, and cell_scratch->pictures
// their pictures.
uint32_t FindPlainBlocks(const FramePlan& plan, const Window& cell, uint32_t blocks, TileWork* work,
                         CellScratch* cell_scratch);

// Whether the values at the centres of a plain block's pixels are within the wanted error of the
// pixels' means: its second differences are small, and no lobe is too narrow for its normals to
// tell. `first_ray`: of the block's rays in work->samples, whose beauty is in `values`, and
// whose hits are hit_of_ray.
inline constexpr uint32_t kNoHit = 0xffffffffu;
bool IsSmooth(const FramePlan& plan, size_t first_ray, const Soa3<double>& values,
              const uint32_t* hit_of_ray, const TileWork& work);

}  // namespace nacre
