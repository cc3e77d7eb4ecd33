// SPDX-License-Identifier: Apache-2.0
// render/evidence.h: how many samples a pixel needs before the agreement of its replicates may be
// trusted. Replicates that all missed a rare feature of a pixel agree, too.
//
// There are three requirements. The first two do not apply to blocks that hold nothing but whole
// spheres on which no shadow falls: nothing rare can be hidden there.
// - The pixel's own samples. On an edge samples have few distinct values, and the replicates may
//   agree by chance, because each of them counts whole samples: n samples cannot resolve less than
//   kByChance / n of the contrast between the least and the greatest value. This does not apply to
//   pixels of known coverage, where the error of the count is corrected (interval.h).
// - The cell's samples. A feature that all samples of some pixels miss is hit by a single sample of
//   other pixels. By Good 1953 the share of what was never seen follows from what was seen once.
//   Witnesses are pixels in which one sample differs from all others by more than the tolerance,
//   and whose neighbours' means do not explain the difference. A feature that matters covers at
//   least a share s = tolerance / contrast of a pixel, and n samples hit it exactly once with a
//   probability of about n s. So 1 / (n s) times as many pixels have such a feature as are
//   witnesses, and m samples miss it with probability e^(-m s). A pixel needs the m for which at
//   most 5 % of the pixels are wrong. Features that most pixels' samples hit repeatedly, such as
//   the noise of an area light, have few witnesses and require nothing. A sample counts with its
//   full value, however much brighter than white: highlights of a hundredth of a pixel may dominate
//   the pixel.
// - Features that are known beforehand (rare_features.h) and smaller than a sample's share of the
//   pixel. Where nothing else in the pixel is rare, it is no witness of what other pixels may have.
//
// Cells lie on a grid of the frame and are evaluated whole, so that none of this depends on the
// region that is rendered.
#pragma once

#include <vector>

#include "render/cell_film.h"
#include "render/dust.h"
#include "render/footprint.h"
#include "render/outline_pixels.h"

namespace nacre {

// Replicates are well distributed: if an edge covers the share of k + f samples of a replicate,
// with f in [0, 1), then k of them hit with probability 1 - f, and otherwise k + 1. All four
// replicates have k hits with probability (1 - f)^4. If all f are equally likely, f exceeds x in (1
// - x)^5 of the cases in which they agree, which is 5 % at x = 0.451. One sample of a replicate is
// 4 / n of the contrast, hence 4 x = 1.80.
inline constexpr double kByChance = 1.80;

// How many hits on a rare feature a pixel's samples must have on average before the spread of the
// replicates shows it: two in each replicate. All four then agree by chance in one of 82 cases (the
// sum of the fourth powers of the Poisson probabilities).
inline constexpr double kExpectedHits = 2 * kReplicates;

// A rare feature of a pixel whose radiance is known: triangles of one material (rare_triangles.cc),
// or texels that look alike (rare_texels.cc).
struct RarePart {
  uint32_t pixel;
  double share;  // of the pixel's samples that hit it
  Rgb radiance;  // what it adds to the pixel, that is, its radiance times the share
};

// The rare features of a cell's pixels that are known before the first sample (rare_features.h).
struct KnownFeatures {
  // By pixel, for small spheres and highlights: how many samples are needed to hit them, and an
  // upper bound of what they add to the pixel's radiance.
  double samples[kCellPixels], radiance[kCellPixels];
  std::vector<RarePart> parts;         // by pixel
  bool has_other_texels[kCellPixels];  // texels that matter and are not in `parts`
};

struct CellEvidence {
  // The two least and the two greatest of all samples of a pixel, misses included.
  double lowest[3][kCellPixels], second_lowest[3][kCellPixels];
  double second_highest[3][kCellPixels], highest[3][kCellPixels];
  // How many samples a pixel needs to find the rare features that matter, judged by its samples so
  // far; 0 if none do.
  double required_samples[kCellPixels];
};

// Must be called before a cell's first sample.
void ClearEvidence(CellEvidence* evidence);

// What adaptive sampling (adaptive.h) knows about the pixels of one cell.
struct CellState {
  std::vector<uint32_t> active;  // pixels that need more samples
  CellSamples samples;
  CellIntervals intervals;  // of pixels that are or were active
  BlockEdges edges;
  OutlinePixels outlines;
  CellDust dust;
  KnownFeatures known;
  CellEvidence evidence;
};

// Must be called after a level: sets required_samples, and clears CellIntervals::narrow of active
// pixels that do not have enough samples for it.
void RequireEvidence(CellState* cell);

}  // namespace nacre
