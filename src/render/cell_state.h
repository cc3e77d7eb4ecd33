// SPDX-License-Identifier: Apache-2.0
// render/cell_state.h: what adaptive sampling (adaptive.h) knows about the pixels of one cell.
#pragma once

#include <vector>

#include "render/cell_film.h"
#include "render/dust.h"
#include "render/evidence.h"
#include "render/footprint.h"
#include "render/outline_pixels.h"

namespace nacre {

struct CellState {
  std::vector<uint32_t> active;  // pixels that need more samples
  CellSamples samples;
  CellIntervals intervals;  // of blocks with active pixels
  BlockEdges edges;
  OutlinePixels outlines;
  CellDust dust;
  KnownFeatures known;
  CellEvidence evidence;
};

}  // namespace nacre
