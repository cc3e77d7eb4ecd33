// SPDX-License-Identifier: Apache-2.0
// render/small_triangles.h: triangles whose projections are so narrow that few samples of a pixel
// hit them. They are binned to the cells of adaptive sampling before the first sample.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "base/huge_pages.h"
#include "base/image.h"
#include "base/vec.h"
#include "scene/primitives.h"
#include "visibility/sphere_bins.h"

namespace nacre {

// Features wider than this, in pixels, are not rare: a pixel's first 16 samples have more hits on
// them on average than kExpectedHits (evidence.h).
inline constexpr double kMaxRareWidth = 2;

// For each cell, the triangles of all meshes whose projection has a height of less than
// kMaxRareWidth over its longest edge, and lies within `margin` of the cell.
struct SmallTriangles {
  Window cells{};                  // the pixels of all cells
  double margin = 0;               // in pixels
  std::vector<uint32_t> end;       // of each cell's list, row by row; empty if all lists are
  HugeArray<uint32_t> primitives;  // ascending in each list
  bool no_others = false;          // triangles that are not narrow are all behind the camera
};

// Bins the narrow triangles. `window` holds the pixels to render. Cells begin at multiples of
// kCellSize in the frame.
SmallTriangles BinSmallTriangles(const PrimitiveNumbers& numbers, const Projector& projector,
                                 const Window& window, double margin, int threads);

using FilmTriangle = std::array<Vec2d, 3>;  // the corners on the film, in pixels

// Calls work(primitive, corners) for the narrow triangles of a cell, in ascending order.
void ForEachNarrowTriangle(const SmallTriangles& triangles, const PrimitiveNumbers& numbers,
                           const Projector& projector, const Window& cell,
                           const std::function<void(uint32_t, const FilmTriangle&)>& work);

// A box on the film, in pixels.
struct FilmBox {
  double x, y;  // of its centre
  double half_width, half_height;
};

// A piece of the projection of a narrow triangle. Film positions and sizes are in pixels. The piece
// covers the share `fill` of a box of at most kMaxRareWidth by kMaxRareWidth.
struct TrianglePiece {
  uint32_t primitive;
  bool front;   // the camera sees its corners in counter-clockwise order
  double x, y;  // of its centroid
  FilmBox box;
  double fill;

  double Area() const { return 4 * box.half_width * box.half_height * fill; }
};

// Calls work(piece) for the pieces within the margin of a cell, in ascending order of triangles.
// Long triangles are cut into several pieces. A cell may have a million, so they are not stored.
void ForEachPiece(const SmallTriangles& triangles, const PrimitiveNumbers& numbers,
                  const Projector& projector, const Window& cell,
                  const std::function<void(const TrianglePiece&)>& work);

}  // namespace nacre
