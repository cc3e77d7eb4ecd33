// SPDX-License-Identifier: Apache-2.0
// visibility/sphere_bins.h: spheres binned to square cells of the image by bounds of their
// projections, so that camera rays find their candidates without a BVH. For camera rays this is
// many times faster than a BVH, and none need be built.
#pragma once

#include <cstdint>
#include <vector>

#include "base/huge_pages.h"
#include "base/image.h"
#include "hit/camera_frame.h"
#include "visibility/geometry.h"

namespace nacre {

// The side of a cell in pixels: cells are as high as the strips that a picture is rendered in.
inline constexpr int kCellSize = 16;
// The first column, or row, of the cell that a pixel's column, or row, lies in.
inline int DownToCell(int pixel) { return pixel / kCellSize * kCellSize; }
// The window extended to whole cells.
inline Window ExtendToCells(const Window& window) {
  const auto up = [](int pixel) { return DownToCell(pixel + kCellSize - 1); };
  return {DownToCell(window.x0), DownToCell(window.y0), up(window.x1), up(window.y1)};
}

// A camera's projection from camera space to pixels.
struct Projector {
  bool perspective = true;
  Vec3d right{1, 0, 0}, down{0, -1, 0}, forward{0, 0, -1};  // unit axes
  double inverse_pixel = 1;           // pixels per slope; orthographic: per length
  double middle_x = 0, middle_y = 0;  // where the axis `forward` crosses the film, in pixels
};

Projector MakeProjector(const CameraFrame& frame);

// The number of pixels per unit length parallel to the film, at a point relative to the camera.
double PixelsPerLength(const Projector& projector, const Vec3d& point);

// A position on the film, in pixels.
struct FilmPoint {
  double x, y;
};
FilmPoint ProjectPoint(const Projector& projector, const Vec3d& point);

// Bounds of a sphere's projection, in pixels; infinite where the sphere extends behind the camera.
struct ProjectedBounds {
  double x0, x1, y0, y1;
  bool visible;  // false: no camera ray can hit the sphere; the bounds are undefined
};

// Bounds a sphere's projection with a margin on each side, so that the box surely contains the
// outline and the samples of all rays that hit the sphere, however these are rounded.
ProjectedBounds Project(const Projector& projector, const TraceSphere& sphere);
// Bounds a sphere's projection with a margin only for the rounding of doubles, which is a small
// part of the box even where that is a billionth of a pixel wide.
ProjectedBounds ProjectClosely(const Projector& projector, const TraceSphere& sphere);

// An upper bound of the rounding errors of bounds and rays at this film coordinate.
double ProjectionMargin(const Projector& projector, double at);
// The terms of ProjectionMargin: a thousandth of a pixel, a billionth of the film coordinate, and
// the rounding of directions of length 1, which matters for telephoto lenses, whose pixels are that
// small.
inline constexpr double kProjectionMargin = 1e-3;
inline constexpr double kRelativeProjectionMargin = 1e-9;
inline constexpr double kDirectionRounding = 1e-15;
// The rounding that ProjectClosely allows for: a few units in the last place of its terms and of
// directions of length 1.
inline constexpr double kProjectionRounding = 8 * 0x1p-52;

// Lists, for each cell, the spheres that any of its camera rays could hit, in ascending order.
struct SphereBins {
  Projector projector;        // of the camera
  Window window;              // the pixels that are binned
  double sample_margin = 0;   // how far outside its pixel a sample may lie, in pixels
  int columns = 0, rows = 0;  // of cells, from the window's corner
  std::vector<uint32_t> end;  // where each cell's list in `spheres` ends, row by row
  HugeArray<uint32_t> spheres;
  HugeArray<uint16_t>
      pixel_rows;  // pixel rows of the cell that the sphere's outline covers, as bits

  size_t Cell(int column, int row) const {
    return static_cast<size_t>(row) * static_cast<size_t>(columns) + static_cast<size_t>(column);
  }
  uint32_t Begin(size_t cell) const { return cell == 0 ? 0 : end[cell - 1]; }
};

// The columns of cells and the rows of pixels that a sphere may cover, from first to last; none if
// first > last. A picture has at most 65536 rows.
struct SphereBox {
  struct Range {
    uint16_t first, last;
  };
  Range columns, rows;
};

// The boxes of spheres in the bins' window, by the bounds of Project and the bins' sample margin.
void FindBoxes(const SphereBins& bins, const TraceSphere* spheres, size_t count, SphereBox* boxes);

// The sample margin if all samples are pixel centres: half a pixel inside the border.
inline constexpr double kPixelCenterMargin = -0.5;

// Bins the spheres for a camera's window. `sample_margin` is how far outside its pixel a sample may
// lie, in pixels. Returns false, with empty bins, if there would be more than `max_entries` in all,
// because many spheres cover much of the picture.
bool BinSpheres(const TraceGeometry& geometry, const CameraFrame& frame, const Window& window,
                double sample_margin, size_t max_entries, int threads, SphereBins* bins);

// Updates the bins after some spheres have changed, with the same result as BinSpheres for the same
// camera. Returns false, and leaves the bins as they were, if there would be more than
// `max_entries`.
bool ChangeBins(const std::vector<ChangedSphere>& changed, size_t max_entries, SphereBins* bins);

}  // namespace nacre
