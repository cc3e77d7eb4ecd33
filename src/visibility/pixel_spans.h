// SPDX-License-Identifier: Apache-2.0
// visibility/pixel_spans.h: which pixels of a tile's rows each sphere's outline reaches. Where
// outlines do not overlap, a ray need be asked nothing but one sphere's exact test.
#pragma once

#include "visibility/tile_kernel.h"

namespace nacre {

// Finds the spans of the candidates' tile, of at most kCellSize rows, where there are none yet.
void FindPixelSpans(const SphereBins& bins, TileCandidates* candidates);

}  // namespace nacre
