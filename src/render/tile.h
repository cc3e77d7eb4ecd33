// SPDX-License-Identifier: Apache-2.0
// render/tile.h: the work on one tile.
#pragma once

#include "render/tile_work.h"

namespace nacre {

// Renders the pixels of `tile`, which lies within the strip and has at most kBatchCapacity of them.
// `blank`: 1 if they show nothing but the background already; then whether they do.
void RenderTile(const FramePlan& plan, const Window& tile, TileWork* work, Strip* strip,
                uint8_t* blank, StageClock* clock, RenderStats* stats);

}  // namespace nacre
