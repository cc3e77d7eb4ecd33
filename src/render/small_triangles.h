// SPDX-License-Identifier: Apache-2.0
// render/small_triangles.h: triangles whose pictures are so narrow that few samples of a pixel hit
// them, binned to the cells of adaptive sampling before the first sample.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "base/huge_pages.h"
#include "base/image.h"
#include "render/filter_shares.h"
#include "scene/primitives.h"
#include "visibility/sphere_bins.h"

namespace nacre {

// Pictures wider than this, in pixels, are found by a pixel's first 16 samples: they expect more
// hits than evidence.h asks for.
inline constexpr double kWidestRare = 2;

// For each cell the triangles of all meshes whose picture is less than kWidestRare high over its
// longest edge and lies in the cell or within `reach` of it: four bytes an entry.
struct SmallTriangles {
  Window cells{};                  // the pixels of all cells
  double reach = 0;                // in pixels
  std::vector<uint32_t> end;       // of each cell's list, row by row; empty: there are none
  HugeArray<uint32_t> primitives;  // ascending in each list
};

// `window`: the pixels to render, of a frame whose cells begin at multiples of kCellSize.
SmallTriangles BinSmallTriangles(const PrimitiveNumbers& numbers, const Projector& projector,
                                 const Window& window, double reach, int threads);

// A part of such a triangle on the film, in pixels: it covers `fill` of a box that is no wider than
// kWidestRare.
struct TrianglePiece {
  uint32_t primitive;
  bool front;         // the camera sees the side from which its corners run counter-clockwise
  uint32_t material;  // of its mesh, which may be a split one
  double x, y;        // its centroid
  FilmBox box;
  double fill;

  double Area() const { return 4 * box.half_width * box.half_height * fill; }
};

// Calls work(piece) for the pieces within reach of a cell of the window, triangle by triangle in
// ascending order. Long triangles are cut. A cell may have a million: none is kept.
void ForEachPiece(const SmallTriangles& triangles, const PrimitiveNumbers& numbers,
                  const Projector& projector, const Window& cell,
                  const std::function<void(const TrianglePiece&)>& work);

}  // namespace nacre
