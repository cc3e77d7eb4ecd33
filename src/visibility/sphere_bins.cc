#include "visibility/sphere_bins.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "visibility/slopes.h"

namespace nacre {
namespace {

// Cells of a row or column that the pixels [low, high] lie in: first to last, none if first > last.
struct CellRange {
  int first, last;
};

CellRange CellsOf(double low, double high, int window_begin, int count) {
  const auto cell = [&](double pixel) {
    return std::clamp(std::floor((pixel - window_begin) / kCellSize), -1.0, double(count));
  };
  return {std::max(static_cast<int>(cell(low)), 0),
          std::min(static_cast<int>(cell(high)), count - 1)};
}

struct CellBox {
  CellRange x, y;
};

}  // namespace

FilmBounds ProjectSphere(const TraceSphere& sphere, const CameraFrame& frame) {
  const double pixel = frame.step_x.length();
  const Vec3d right = frame.step_x / pixel;
  const Vec3d down = frame.step_y / pixel;
  const double x = sphere.center.dot(right);
  const double y = sphere.center.dot(down);
  const double z = sphere.center.dot(frame.forward);
  const double middle_x = -frame.corner.dot(right) / pixel;
  const double middle_y = -frame.corner.dot(down) / pixel;
  FilmBounds bounds{};
  bounds.visible = z + sphere.radius > 0;
  if (!bounds.visible) return bounds;
  Interval across{x - sphere.radius, x + sphere.radius};
  Interval along{y - sphere.radius, y + sphere.radius};
  if (frame.projection == Projection::kPerspective) {
    across = Slopes(x, z, sphere.radius);
    along = Slopes(y, z, sphere.radius);
  }
  // A thousandth of a pixel, and a billionth of the distance on the film, are far more than all the
  // roundings here and of the rays.
  const auto place = [&](double slope, double middle, double sign) {
    const double at = slope / pixel;
    return at + middle + sign * (1e-3 + 1e-9 * std::abs(at));
  };
  bounds.x0 = place(across.low, middle_x, -1);
  bounds.x1 = place(across.high, middle_x, 1);
  bounds.y0 = place(along.low, middle_y, -1);
  bounds.y1 = place(along.high, middle_y, 1);
  return bounds;
}

bool BinSpheres(const TraceGeometry& geometry, const CameraFrame& frame, const Window& window,
                double reach, size_t max_entries, SphereBins* bins) {
  *bins = {};
  bins->window = window;
  bins->columns = (window.width() + kCellSize - 1) / kCellSize;
  bins->rows = (window.height() + kCellSize - 1) / kCellSize;
  bins->end.assign(static_cast<size_t>(bins->columns) * static_cast<size_t>(bins->rows), 0);
  std::vector<CellBox> boxes(geometry.spheres.size());
  size_t entries = 0;
  for (size_t i = 0; i < boxes.size(); ++i) {
    const FilmBounds b = ProjectSphere(geometry.spheres[i], frame);
    boxes[i] = {{0, -1}, {0, -1}};
    if (!b.visible) continue;
    boxes[i] = {CellsOf(b.x0 - reach, b.x1 + reach, window.x0, bins->columns),
                CellsOf(b.y0 - reach, b.y1 + reach, window.y0, bins->rows)};
    const auto& [x, y] = boxes[i];
    for (int row = y.first; row <= y.last; ++row) {
      for (int column = x.first; column <= x.last; ++column) ++bins->end[bins->Cell(column, row)];
    }
    if (y.first <= y.last && x.first <= x.last) {
      entries +=
          static_cast<size_t>(y.last - y.first + 1) * static_cast<size_t>(x.last - x.first + 1);
    }
    if (entries > max_entries) {
      *bins = {};
      return false;
    }
  }
  // Counts become beginnings, and these, as spheres are put in, ends.
  uint32_t sum = 0;
  for (uint32_t& count : bins->end) sum += std::exchange(count, sum);
  bins->spheres.resize(entries);
  for (size_t i = 0; i < boxes.size(); ++i) {
    const auto& [x, y] = boxes[i];
    for (int row = y.first; row <= y.last; ++row) {
      for (int column = x.first; column <= x.last; ++column) {
        bins->spheres[bins->end[bins->Cell(column, row)]++] = static_cast<uint32_t>(i);
      }
    }
  }
  return true;
}

}  // namespace nacre
