// SPDX-License-Identifier: Apache-2.0
// render/dust.h: handles pixels in which small spheres and thin triangles cover little of the
// background, and nothing else is in front of it. Samples of the whole pixel would seldom hit them.
// So samples are restricted to patches that contain the shapes' projections: the rest of the pixel
// is known to be background.
//
// For a random point in one of the patches, which is chosen with a probability proportional to its
// area, the value
//   background + share / patches * (radiance - background)
// has the pixel as its mean, where `share` is the sum of the patches' areas as shares of the pixel
// and `patches` is the number of patches that the point lies in.
#pragma once

#include <span>
#include <vector>

#include "render/cell.h"

namespace nacre {

// A parallelogram on the film, in pixels, or the half of it at its corner.
struct DustPatch {
  Vec2d corner, sides[2];
  bool triangle;
  double area;
};

struct CellDust {
  // The part of the pixel that its samples are spread over: 1, or the area of the patches that hold
  // its dust, as shares of the pixel.
  double sampled_share[kCellPixels];
  bool any;                        // whether pixels have patches
  std::vector<DustPatch> patches;  // by pixel; valid if `any`
  uint32_t first_patch[kCellPixels + 1];
  // By sample of the list that MoveToDust was given last: share / patches.
  std::vector<double> sample_share = std::vector<double>(kBatchCapacity);
};

// Finds these pixels and their patches, for box filters in front of a background of one colour.
// Must be called before a cell's first sample.
void FindDust(const FramePlan& plan, const Window& cell, const TileShapes& shapes, CellDust* dust);

// Moves samples of such pixels into their patches. `film` has `count` samples of each entry of the
// list, one entry after the other.
void MoveToDust(const FramePlan& plan, const Window& cell, std::span<const SampleEntry> list,
                size_t count, FilmBatch* film, CellDust* dust);

// Replaces the values of such samples by the value given above.
void WeighDust(double background, std::span<const SampleEntry> list, size_t count,
               const CellDust& dust, double* values);

}  // namespace nacre
