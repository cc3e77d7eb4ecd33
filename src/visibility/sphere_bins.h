// SPDX-License-Identifier: Apache-2.0
// visibility/sphere_bins.h: spheres binned to square cells of the image by bounds of their
// projections, so that camera rays find their candidates without a tree. For camera rays alone this
// is many times faster than one, and there is nothing to build.
#pragma once

#include <cstdint>
#include <vector>

#include "base/huge_pages.h"
#include "base/image.h"
#include "hit/camera_frame.h"
#include "visibility/geometry.h"

namespace nacre {

// Cells are as high as the strips that a picture is rendered in.
inline constexpr int kCellSize = 16;

// A camera as spheres are projected by it.
struct Projector {
  bool perspective;
  Vec3d right, down, forward;  // unit axes
  double inverse_pixel;        // pixels per slope; orthographic: per length
  double middle_x, middle_y;   // where `forward` through the camera meets the film, in pixels
};

Projector MakeProjector(const CameraFrame& frame);

// A sphere's bounds on the film, in pixels; infinite where it reaches beside or behind the camera.
struct FilmBounds {
  double x0, x1, y0, y1;
  bool visible;  // false: no camera ray can hit the sphere; the bounds are undefined
};

// With a margin at each side: for a box that the outline is in.
FilmBounds Project(const Projector& projector, const TraceSphere& sphere);

// More than all roundings of bounds and rays come to at this coordinate of the film.
double FilmMargin(const Projector& projector, double at);
inline constexpr double kMarginOfPlace = 1e-9;  // what grows with the coordinate

// For each cell the spheres that any of its camera rays could hit, in ascending order.
struct SphereBins {
  Projector projector;        // of their camera
  Window window;              // the pixels that are binned
  double reach = 0;           // of their samples
  int columns = 0, rows = 0;  // of cells, from the window's corner
  std::vector<uint32_t> end;  // of each cell's spheres, row by row
  HugeArray<uint32_t> spheres;
  HugeArray<uint16_t> pixel_rows;  // of the cell that the sphere's outline reaches, as bits

  size_t Cell(int column, int row) const {
    return static_cast<size_t>(row) * static_cast<size_t>(columns) + static_cast<size_t>(column);
  }
  uint32_t Begin(size_t cell) const { return cell == 0 ? 0 : end[cell - 1]; }
};

// Half a pixel within its border.
inline constexpr double kReachOfCenters = -0.5;

// `reach`: how far a pixel's samples may lie outside it, in pixels; kReachOfCenters if they are all
// its centre. Fails, with empty bins, if there would be more than `max_entries` in all: many
// spheres that cover much of the picture.
bool BinSpheres(const TraceGeometry& geometry, const CameraFrame& frame, const Window& window,
                double reach, size_t max_entries, int threads, SphereBins* bins);

}  // namespace nacre
