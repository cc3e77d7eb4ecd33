// SPDX-License-Identifier: Apache-2.0
#include "visibility/sphere_bins.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "visibility/cell_lists.h"
#include "visibility/slopes.h"

namespace nacre {
namespace {

// Places from first to last; none if first > last.
struct Range {
  uint16_t first, last;
};

// Of cells across and of pixels down; of the latter are 65536 at most.
struct SphereBox {
  Range columns, rows;
};

// Places of `size` pixels, `count` in all from `begin` on, that the pixels [low, high] lie in.
Range PlacesOf(double low, double high, int begin, int size, int count) {
  const double first = std::max((low - begin) / size, 0.0);
  const double last = std::min((high - begin) / size, count - 1.0);
  if (!(last >= 0 && first < count)) return {1, 0};
  return {static_cast<uint16_t>(first), static_cast<uint16_t>(last)};
}

// A cell's pixel rows that lie in the range, as bits.
uint16_t RowsOfCell(const Range& rows, size_t cell_row) {
  const int cell_begin = static_cast<int>(cell_row) * kCellSize;
  const int first = std::max(rows.first - cell_begin, 0);
  const int last = std::min(rows.last - cell_begin, kCellSize - 1);
  return static_cast<uint16_t>((0xffffu << first) & (0xffffu >> (kCellSize - 1 - last)));
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

// A thousandth of a pixel, and a billionth of the distance on the film. Under a telephoto lens,
// whose pixels are that small, what rounds directions of length 1 counts, too.
double Projector::Margin(double at) const {
  return 1e-3 + kMarginOfPlace * std::abs(at) + 1e-15 * inverse_pixel_;
}

FilmBounds Projector::Project(const TraceSphere& sphere) const {
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
  bounds.x0 -= Margin(bounds.x0);
  bounds.x1 += Margin(bounds.x1);
  bounds.y0 -= Margin(bounds.y0);
  bounds.y1 += Margin(bounds.y1);
  return bounds;
}

bool BinSpheres(const TraceGeometry& geometry, const CameraFrame& frame, const Window& window,
                double reach, size_t max_entries, int threads, SphereBins* bins) {
  *bins = {};
  bins->window = window;
  bins->reach = reach;
  bins->columns = (window.width() + kCellSize - 1) / kCellSize;
  bins->rows = (window.height() + kCellSize - 1) / kCellSize;
  const Projector projector(frame);
  HugeArray<SphereBox> boxes(geometry.spheres.size());
  ParallelFor(CellListPieces(boxes.size()), threads, [&](size_t piece) {
    const auto [begin, end] = CellListPiece(boxes.size(), piece);
    for (size_t i = begin; i < end; ++i) {
      const FilmBounds b = projector.Project(geometry.spheres[i]);
      boxes[i] = {PlacesOf(b.x0 - reach, b.x1 + reach, window.x0, kCellSize, bins->columns),
                  PlacesOf(b.y0 - reach, b.y1 + reach, window.y0, 1, window.height())};
      if (!b.visible) boxes[i].rows = {1, 0};
    }
  });
  const auto for_cells = [&](size_t i, const auto& emit) {
    const auto& [columns, rows] = boxes[i];
    if (rows.first > rows.last) return;
    for (int row = rows.first / kCellSize; row <= rows.last / kCellSize; ++row) {
      for (int column = columns.first; column <= columns.last; ++column) {
        emit(bins->Cell(column, row));
      }
    }
  };
  const size_t cells = static_cast<size_t>(bins->columns) * static_cast<size_t>(bins->rows);
  const bool fits = SortIntoCells(
      geometry.spheres.size(), cells, max_entries, threads, for_cells, &bins->end,
      [&](size_t entries) {
        bins->spheres = HugeArray<uint32_t>(entries);
        bins->pixel_rows = HugeArray<uint16_t>(entries);
      },
      [&](size_t i, size_t cell, uint32_t position) {
        bins->spheres[position] = static_cast<uint32_t>(i);
        bins->pixel_rows[position] =
            RowsOfCell(boxes[i].rows, cell / static_cast<size_t>(bins->columns));
      });
  if (!fits) *bins = {};
  return fits;
}

}  // namespace nacre
