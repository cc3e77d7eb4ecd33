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

// For each cell the spheres that any of its camera rays could hit, in ascending order.
struct SphereBins {
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

// A sphere's bounds on the film, in pixels; infinite where it reaches beside or behind the camera.
struct FilmBounds {
  double x0, x1, y0, y1;
  bool visible;  // false: no camera ray can hit the sphere; the bounds are undefined
};

// Spheres as a camera sees them.
class Projector {
 public:
  explicit Projector(const CameraFrame& frame);

  // The bounds, with a margin at each side: for a box that the outline is in.
  FilmBounds Project(const TraceSphere& sphere) const;

  // More than all roundings of bounds and rays come to at this coordinate of the film.
  double Margin(double at) const;
  static constexpr double kMarginOfPlace = 1e-9;  // what grows with the coordinate

  // The camera's axes, pixels per slope, and where the axis meets the film, in pixels.
  const Vec3d& right() const { return right_; }
  const Vec3d& down() const { return down_; }
  const Vec3d& forward() const { return forward_; }
  double inverse_pixel() const { return inverse_pixel_; }
  double middle_x() const { return middle_x_; }
  double middle_y() const { return middle_y_; }

 private:
  bool perspective_;
  Vec3d forward_;
  double inverse_pixel_;
  Vec3d right_, down_;
  double middle_x_, middle_y_;  // of the film, in pixels
};

// `reach`: how far a pixel's samples lie outside it, in pixels. Fails, with empty bins, if there
// would be more than `max_entries` in all: many spheres that cover much of the picture.
bool BinSpheres(const TraceGeometry& geometry, const CameraFrame& frame, const Window& window,
                double reach, size_t max_entries, int threads, SphereBins* bins);

}  // namespace nacre
