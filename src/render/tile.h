// SPDX-License-Identifier: Apache-2.0
// render/tile.h: renders one tile.
#pragma once

#include "render/tile_work.h"

namespace nacre {

// Renders all samples of the pixels of `tile`, at most kBatchCapacity pixels within the strip.
// `blank` is 1 if the strip already holds the background in the whole tile, and is updated.
void RenderTile(const FramePlan& plan, const Window& tile, TileWork* work, Strip* strip,
                uint8_t* blank);

// Adds samples [first, end) of the pixels of `tile` to its film, which StartTile has cleared before
// the first sample. Not for FilmPlan::one_sample.
void AddTileSamples(const FramePlan& plan, const Window& tile, int first, int end, TileWork* work,
                    TileFilm* film);

}  // namespace nacre
