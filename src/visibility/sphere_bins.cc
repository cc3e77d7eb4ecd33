// SPDX-License-Identifier: Apache-2.0
#include "visibility/sphere_bins.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "base/parallel.h"
#include "visibility/cell_lists.h"
#include "visibility/slopes.h"

namespace nacre {
namespace {

// Calls emit(cell, row of cells) for each cell that the box overlaps.
template <class Emit>
void ForCells(const SphereBins& bins, const SphereBox& box, const Emit& emit) {
  const auto& [columns, rows] = box;
  if (rows.first > rows.last) return;
  for (int row = rows.first / kCellSize; row <= rows.last / kCellSize; ++row) {
    for (int column = columns.first; column <= columns.last; ++column) {
      emit(bins.Cell(column, row), row);
    }
  }
}

// A cell's pixel rows that lie in the range, as bits.
uint16_t RowsOfCell(const SphereBox::Range& rows, int cell_row) {
  const int cell_begin = cell_row * kCellSize;
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

double ProjectionMargin(const Projector& projector, double at) {
  return kProjectionMargin + kRelativeProjectionMargin * std::abs(at) +
         kDirectionRounding * projector.inverse_pixel;
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
  const auto rounding = [&](double at, double middle) {
    return kProjectionRounding * (std::abs(at - middle) + std::abs(middle) + p.inverse_pixel);
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
  *bins = {};  // they stay empty if memory runs out below
  SphereBins made;
  made.window = window;
  made.sample_margin = sample_margin;
  made.columns = (window.width() + kCellSize - 1) / kCellSize;
  made.rows = (window.height() + kCellSize - 1) / kCellSize;
  made.projector = MakeProjector(frame);
  HugeArray<SphereBox> boxes(geometry.spheres.size());
  ParallelFor(CellListPieces(boxes.size()), threads, [&](size_t piece) {
    const auto [begin, end] = CellListPiece(boxes.size(), piece);
    FindBoxes(made, geometry.spheres.data() + begin, end - begin, boxes.data() + begin);
  });
  const auto for_cells = [&](size_t i, const auto& emit) { ForCells(made, boxes[i], emit); };
  const size_t cells = static_cast<size_t>(made.columns) * static_cast<size_t>(made.rows);
  const bool fits = SortIntoCells(
      geometry.spheres.size(), cells, max_entries, threads, for_cells, &made.end,
      [&](size_t entries) {
        made.spheres = HugeArray<uint32_t>(entries);
        made.pixel_rows = HugeArray<uint16_t>(entries);
      },
      [&](size_t i, size_t, uint32_t position, int row) {
        made.spheres[position] = static_cast<uint32_t>(i);
        made.pixel_rows[position] = RowsOfCell(boxes[i].rows, row);
      });
  if (fits) *bins = std::move(made);
  return fits;
}

bool ChangeBins(const std::vector<ChangedSphere>& changed, size_t max_entries, SphereBins* bins) {
  // An entry that goes or comes. That of a sphere that stays in a cell does both, because its pixel
  // rows may differ.
  struct Edit {
    size_t cell;
    uint32_t sphere;
    bool comes;
    uint16_t pixel_rows;
    bool operator<(const Edit& other) const {
      return std::tie(cell, sphere, comes) < std::tie(other.cell, other.sphere, other.comes);
    }
  };
  std::vector<Edit> edits;
  const auto add = [&](const TraceSphere& sphere, uint32_t index, bool comes) {
    SphereBox box;
    FindBoxes(*bins, &sphere, 1, &box);
    ForCells(*bins, box, [&](size_t cell, int row) {
      edits.push_back({cell, index, comes, RowsOfCell(box.rows, row)});
    });
  };
  for (const ChangedSphere& sphere : changed) {
    add(sphere.before, sphere.index, false);
    add(sphere.now, sphere.index, true);
  }
  if (edits.empty()) return true;
  std::sort(edits.begin(), edits.end());
  const auto come = static_cast<size_t>(
      std::count_if(edits.begin(), edits.end(), [](const Edit& edit) { return edit.comes; }));
  const size_t size = bins->spheres.size() + come - (edits.size() - come);
  if (size > max_entries) return false;
  HugeArray<uint32_t> spheres(size);
  HugeArray<uint16_t> pixel_rows(size);
  uint32_t from = 0, to = 0;
  const auto copy_until = [&](uint32_t end) {
    std::copy(bins->spheres.data() + from, bins->spheres.data() + end, spheres.data() + to);
    std::copy(bins->pixel_rows.data() + from, bins->pixel_rows.data() + end,
              pixel_rows.data() + to);
    to += end - from;
    from = end;
  };
  auto edit = edits.begin();
  for (size_t cell = 0; cell < bins->end.size(); ++cell) {
    const uint32_t end = bins->end[cell];
    for (; edit != edits.end() && edit->cell == cell; ++edit) {
      const uint32_t* const list = bins->spheres.data();
      copy_until(
          static_cast<uint32_t>(std::lower_bound(list + from, list + end, edit->sphere) - list));
      if (edit->comes) {
        spheres[to] = edit->sphere;
        pixel_rows[to++] = edit->pixel_rows;
      } else {
        ++from;
      }
    }
    copy_until(end);
    bins->end[cell] = to;
  }
  bins->spheres = std::move(spheres);
  bins->pixel_rows = std::move(pixel_rows);
  return true;
}

}  // namespace nacre
