// SPDX-License-Identifier: Apache-2.0
#include "visibility/sphere_bins.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "visibility/cell_lists.h"
#include "visibility/slopes.h"

namespace nacre {
namespace {

// Cells, at most 4096, of a row or column that the pixels [low, high] lie in: first to last, none
// if first > last.
struct CellRange {
  int16_t first, last;
};

struct CellBox {
  CellRange x, y;
};

CellRange CellsOf(double low, double high, int window_begin, int count) {
  const auto cell = [&](double pixel) {
    return std::clamp(std::floor((pixel - window_begin) / kCellSize), -1.0, double(count));
  };
  return {static_cast<int16_t>(std::max(cell(low), 0.0)),
          static_cast<int16_t>(std::min(cell(high), count - 1.0))};
}

}  // namespace

Projector::Projector(const CameraFrame& frame)
    : perspective_(frame.projection == Projection::kPerspective),
      forward_(frame.forward),
      inverse_pixel_(1 / frame.step_x.length()),
      right_(frame.step_x * inverse_pixel_),
      down_(frame.step_y * inverse_pixel_),
      middle_x_(-frame.corner.dot(right_) * inverse_pixel_),
      middle_y_(-frame.corner.dot(down_) * inverse_pixel_) {}

FilmBounds Projector::Tangents(const TraceSphere& sphere) const {
  const double x = sphere.center.dot(right_);
  const double y = sphere.center.dot(down_);
  const double z = sphere.center.dot(forward_);
  FilmBounds bounds{};
  bounds.visible = z + sphere.radius > 0;
  if (!bounds.visible) return bounds;
  Interval across{x - sphere.radius, x + sphere.radius};
  Interval along{y - sphere.radius, y + sphere.radius};
  if (perspective_) {
    across = Slopes(x, z, sphere.radius);
    along = Slopes(y, z, sphere.radius);
  }
  bounds.x0 = across.low * inverse_pixel_ + middle_x_;
  bounds.x1 = across.high * inverse_pixel_ + middle_x_;
  bounds.y0 = along.low * inverse_pixel_ + middle_y_;
  bounds.y1 = along.high * inverse_pixel_ + middle_y_;
  return bounds;
}

// A thousandth of a pixel, and a billionth of the distance on the film. Under a telephoto lens,
// whose pixels are that small, what rounds directions of length 1 counts, too.
double Projector::Margin(double at) const {
  return 1e-3 + 1e-9 * std::abs(at) + 1e-15 * inverse_pixel_;
}

FilmBounds Projector::Project(const TraceSphere& sphere) const {
  FilmBounds bounds = Tangents(sphere);
  bounds.x0 -= Margin(bounds.x0);
  bounds.x1 += Margin(bounds.x1);
  bounds.y0 -= Margin(bounds.y0);
  bounds.y1 += Margin(bounds.y1);
  return bounds;
}

// By slopes u = x / z, v = y / z the outline is (x u + y v + z)^2 = (|c|^2 - r^2) (u^2 + v^2 + 1):
// an ellipse about z (x, y) / (z^2 - r^2), with half its width squared, the skew and half its
// height squared for the entries of the inverse of its matrix.
double Projector::Skew(const TraceSphere& sphere) const {
  const double x = sphere.center.dot(right_);
  const double y = sphere.center.dot(down_);
  const double z = sphere.center.dot(forward_);
  const double scale = sphere.radius * inverse_pixel_ / ((z - sphere.radius) * (z + sphere.radius));
  return x * y * scale * scale;
}

bool BinSpheres(const TraceGeometry& geometry, const CameraFrame& frame, const Window& window,
                double reach, size_t max_entries, int threads, SphereBins* bins) {
  *bins = {};
  bins->window = window;
  bins->reach = reach;
  bins->columns = (window.width() + kCellSize - 1) / kCellSize;
  bins->rows = (window.height() + kCellSize - 1) / kCellSize;
  const Projector projector(frame);
  HugeArray<CellBox> boxes(geometry.spheres.size());
  ParallelFor(CellListPieces(boxes.size()), threads, [&](size_t piece) {
    const auto [begin, end] = CellListPiece(boxes.size(), piece);
    for (size_t i = begin; i < end; ++i) {
      const FilmBounds b = projector.Project(geometry.spheres[i]);
      boxes[i] = {CellsOf(b.x0 - reach, b.x1 + reach, window.x0, bins->columns),
                  CellsOf(b.y0 - reach, b.y1 + reach, window.y0, bins->rows)};
      if (!b.visible) boxes[i] = {{0, -1}, {0, -1}};
    }
  });
  const auto for_cells = [&](size_t i, const auto& emit) {
    const auto& [x, y] = boxes[i];
    for (int row = y.first; row <= y.last; ++row) {
      for (int column = x.first; column <= x.last; ++column) emit(bins->Cell(column, row));
    }
  };
  const size_t cells = static_cast<size_t>(bins->columns) * static_cast<size_t>(bins->rows);
  const bool fits = SortIntoCells(
      geometry.spheres.size(), cells, max_entries, threads, for_cells, &bins->end,
      [&](size_t entries) { bins->spheres = HugeArray<uint32_t>(entries); },
      [&](size_t i, uint32_t position) { bins->spheres[position] = static_cast<uint32_t>(i); });
  if (!fits) *bins = {};
  return fits;
}

}  // namespace nacre
