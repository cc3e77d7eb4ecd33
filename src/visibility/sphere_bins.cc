// SPDX-License-Identifier: Apache-2.0
#include "visibility/sphere_bins.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "visibility/cell_lists.h"
#include "visibility/slopes.h"

namespace nacre {
namespace {

// Indices from first to last; empty if first > last.
struct IndexRange {
  uint16_t first, last;
};

// The columns of cells and the rows of pixels that a sphere may cover. A picture has at most 65536
// rows.
struct SphereBox {
  IndexRange columns, rows;
};

// The intervals of `size` pixels that [low, high] overlaps, of `count` that begin at pixel `begin`.
IndexRange IndicesOf(double low, double high, int begin, int size, int count) {
  const double first = std::max((low - begin) / size, 0.0);
  const double last = std::min((high - begin) / size, count - 1.0);
  if (!(last >= 0 && first < count)) return {1, 0};
  return {static_cast<uint16_t>(first), static_cast<uint16_t>(last)};
}

// A cell's pixel rows that lie in the range, as bits.
uint16_t RowsOfCell(const IndexRange& rows, size_t cell_row) {
  const int cell_begin = static_cast<int>(cell_row) * kCellSize;
  const int first = std::max(rows.first - cell_begin, 0);
  const int last = std::min(rows.last - cell_begin, kCellSize - 1);
  return static_cast<uint16_t>((0xffffu << first) & (0xffffu >> (kCellSize - 1 - last)));
}

}  // namespace

Projector MakeProjector(const CameraFrame& frame) {
  Projector p;
  p.perspective = frame.projection == Projection::kPerspective;
  p.inverse_pixel = 1 / frame.step_x.length();
  p.right = frame.step_x * p.inverse_pixel;
  p.down = frame.step_y * p.inverse_pixel;
  p.forward = frame.forward;
  p.middle_x = -frame.corner.dot(p.right) * p.inverse_pixel;
  p.middle_y = -frame.corner.dot(p.down) * p.inverse_pixel;
  return p;
}

double PixelsPerLength(const Projector& projector, const Vec3d& point) {
  return projector.inverse_pixel / (projector.perspective ? point.dot(projector.forward) : 1);
}

FilmPoint ProjectPoint(const Projector& projector, const Vec3d& point) {
  const double scale = PixelsPerLength(projector, point);
  return {point.dot(projector.right) * scale + projector.middle_x,
          point.dot(projector.down) * scale + projector.middle_y};
}

// A thousandth of a pixel and a billionth of the film coordinate. The last term is the rounding of
// directions of length 1, which matters for telephoto lenses, whose pixels are that small.
double ProjectionMargin(const Projector& projector, double at) {
  return 1e-3 + kRelativeProjectionMargin * std::abs(at) + 1e-15 * projector.inverse_pixel;
}

ProjectedBounds ProjectClosely(const Projector& p, const TraceSphere& sphere) {
  const double x = sphere.center.dot(p.right);
  const double y = sphere.center.dot(p.down);
  const double z = sphere.center.dot(p.forward);
  ProjectedBounds bounds{};
  bounds.visible = z + sphere.radius > 0;
  if (!bounds.visible) return bounds;
  SlopeRange across{x - sphere.radius, x + sphere.radius};
  SlopeRange along{y - sphere.radius, y + sphere.radius};
  if (p.perspective) {
    across = Slopes(x, z, sphere.radius);
    along = Slopes(y, z, sphere.radius);
  }
  bounds.x0 = across.low * p.inverse_pixel + p.middle_x;
  bounds.x1 = across.high * p.inverse_pixel + p.middle_x;
  bounds.y0 = along.low * p.inverse_pixel + p.middle_y;
  bounds.y1 = along.high * p.inverse_pixel + p.middle_y;
  // A few units in the last place of the terms above, and of directions of length 1.
  const auto rounding = [&](double at, double middle) {
    return 8 * 0x1p-52 * (std::abs(at - middle) + std::abs(middle) + p.inverse_pixel);
  };
  bounds.x0 -= rounding(bounds.x0, p.middle_x);
  bounds.x1 += rounding(bounds.x1, p.middle_x);
  bounds.y0 -= rounding(bounds.y0, p.middle_y);
  bounds.y1 += rounding(bounds.y1, p.middle_y);
  return bounds;
}

ProjectedBounds Project(const Projector& p, const TraceSphere& sphere) {
  ProjectedBounds bounds = ProjectClosely(p, sphere);
  if (!bounds.visible) return bounds;
  bounds.x0 -= ProjectionMargin(p, bounds.x0);
  bounds.x1 += ProjectionMargin(p, bounds.x1);
  bounds.y0 -= ProjectionMargin(p, bounds.y0);
  bounds.y1 += ProjectionMargin(p, bounds.y1);
  return bounds;
}

bool BinSpheres(const TraceGeometry& geometry, const CameraFrame& frame, const Window& window,
                double sample_margin, size_t max_entries, int threads, SphereBins* bins) {
  *bins = {};
  bins->window = window;
  bins->sample_margin = sample_margin;
  bins->columns = (window.width() + kCellSize - 1) / kCellSize;
  bins->rows = (window.height() + kCellSize - 1) / kCellSize;
  bins->projector = MakeProjector(frame);
  HugeArray<SphereBox> boxes(geometry.spheres.size());
  ParallelFor(CellListPieces(boxes.size()), threads, [&](size_t piece) {
    const auto [begin, end] = CellListPiece(boxes.size(), piece);
    for (size_t i = begin; i < end; ++i) {
      const ProjectedBounds b = Project(bins->projector, geometry.spheres[i]);
      boxes[i] = {
          IndicesOf(b.x0 - sample_margin, b.x1 + sample_margin, window.x0, kCellSize,
                    bins->columns),
          IndicesOf(b.y0 - sample_margin, b.y1 + sample_margin, window.y0, 1, window.height())};
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
