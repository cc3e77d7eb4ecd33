// SPDX-License-Identifier: Apache-2.0
// visibility/pixel_spans.h: the pixels that each sphere's outline covers in each row of a tile.
// Where outlines do not overlap, a ray needs the exact test of only one sphere.
#pragma once

#include "visibility/sphere_bins.h"
#include "visibility/tile_candidates.h"

namespace nacre {

// Fills candidates->spans, which must be empty. The tile has at most kCellSize rows.
void FindPixelSpans(const SphereBins& bins, TileCandidates* candidates);

}  // namespace nacre
