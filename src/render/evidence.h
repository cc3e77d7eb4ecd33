// SPDX-License-Identifier: Apache-2.0
// render/evidence.h: how many samples a pixel must have before the agreement of its replicates
// counts. Replicates that all missed what is rare in a pixel agree, too.
//
// Three things are asked of a pixel in which anything may be, that is outside the blocks that hold
// nothing but whole spheres that no shadow falls on:
// - Its own samples. Between their least and their greatest value one more sample may lie, and
//   samples that take few values agree by chance: n samples do not settle less than kUnseen / n of
//   that contrast.
// - Its cell's samples. What all samples of some pixels miss, a single sample of other pixels has
//   met (Good 1953: the share of what was never seen follows from what was seen once). Witnesses
//   are pixels in which one sample differs from all others by more than is wanted, and whose
//   neighbours' means do not explain it. What matters covers a share wanted / contrast of a pixel
//   at least, and n samples meet it once with about n times that probability: so many times as many
//   pixels have it as are witnesses. With m samples e^(-m wanted / contrast) of these miss it: m is
//   enough where that leaves 5 % of the pixels. What most pixels' samples meet again and again, the
//   noise of a light with an extent, say, has few witnesses and asks for nothing.
// - What is known beforehand (rare_features.h): a part of the pixel that is smaller than a sample's
//   share of it.
//
// Cells lie on a grid of the frame and are evaluated whole, so that none of this depends on crops.
#pragma once

#include "render/cell_scratch.h"

namespace nacre {

// The rule of three: what a sample hits with probability p is missed by all of n in 5 % of cases
// where n p = 3, for e^-3 = 0.0498.
inline constexpr double kUnseen = 3;

// Before a cell's first sample.
void ClearEvidence(CellScratch* cell_scratch);

// After a level: takes from the intervals of the active pixels those bits that say that they are
// narrow enough where there is too little evidence for it.
void RequireEvidence(const FramePlan& plan, CellScratch* cell_scratch);

}  // namespace nacre
