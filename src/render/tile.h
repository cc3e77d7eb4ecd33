// SPDX-License-Identifier: Apache-2.0
// render/tile.h: the work on one tile.
#pragma once

#include "render/tile_work.h"

namespace nacre {

// Renders the pixels of `tile`, which lies within the strip and has at most kBatchCapacity of them.
// `blank`, in: 1 if the strip already holds the background there; out: whether it does now.
void RenderTile(const FramePlan& plan, const Window& tile, TileWork* work, Strip* strip,
                uint8_t* blank, StageClock* clock, RenderStats* stats);

// Adds samples [first, end) of the pixels of `tile` to its film, which StartTile has emptied before
// the first of them. Not for plans whose film has one sample.
void AddSamples(const FramePlan& plan, const Window& tile, int first, int end, TileWork* work,
                TileFilm* film, StageClock* clock, RenderStats* stats);

}  // namespace nacre
