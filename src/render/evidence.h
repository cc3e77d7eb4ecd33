// SPDX-License-Identifier: Apache-2.0
// render/evidence.h: how many samples a pixel must have before the agreement of its replicates
// counts. Replicates that all missed what is rare in a pixel agree, too.
//
// Three things are asked of a pixel in which anything may be, that is outside the blocks that hold
// nothing but whole spheres that no shadow falls on:
// - Its own samples. Those that take few values, on an edge, say, agree by chance, as each
//   replicate can only tell whole numbers of them: n samples do not settle less than
//   kByChance / n of the contrast between their least and their greatest value. Not where it is
//   known what share of the pixel a sphere covers: what is wrong by chance is taken back there
//   (interval.h).
// - Its cell's samples. What all samples of some pixels miss, a single sample of other pixels has
//   met (Good 1953: the share of what was never seen follows from what was seen once). Witnesses
//   are pixels in which one sample differs from all others by more than is wanted, and whose
//   neighbours' means do not explain it. What matters covers a share wanted / contrast of a pixel
//   at least, and n samples meet it once with about n times that probability: so many times as many
//   pixels have it as are witnesses. With m samples e^(-m wanted / contrast) of these miss it: m is
//   enough where that leaves 5 % of the pixels. What most pixels' samples meet again and again, the
//   noise of a light with an extent, say, has few witnesses and asks for nothing. A sample counts
//   as what it is, however much brighter than white: highlights of a hundredth of a pixel may be
//   most of what it shows.
// - What is known beforehand (rare_features.h): a part of the pixel that is smaller than a sample's
//   share of it.
//
// Cells lie on a grid of the frame and are evaluated whole, so that none of this depends on crops.
#pragma once

#include "render/cell_scratch.h"

namespace nacre {

// Replicates are well spread: of an edge that is to have k + f of a replicate's samples, f below 1,
// each has k with probability 1 - f and else k + 1. All four have k in (1 - f)^4 of cases, so that
// f, if any is as likely, is more than x in (1 - x)^5 of the cases in which they agree: 5 % at
// x = 0.451. A replicate's sample is 4 / n of the contrast: 4 x = 1.80.
inline constexpr double kByChance = 1.80;

// Hits on rare things that a pixel must expect before the spread of its replicates tells of them:
// two in each, so that all agree by chance in one of 82 cases (the sum of the fourth powers of
// Poisson's probabilities).
inline constexpr double kExpectedHits = 2 * kReplicates;

// Before a cell's first sample.
void ClearEvidence(CellScratch* cell_scratch);

// After a level: takes from the intervals of the active pixels those bits that say that they are
// narrow enough where there is too little evidence for it.
void RequireEvidence(CellScratch* cell_scratch);

}  // namespace nacre
