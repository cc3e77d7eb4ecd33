// SPDX-License-Identifier: Apache-2.0
#include "render/small_triangles.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <optional>

#include <Imath/ImathBox.h>

#include "scene/scene.h"
#include "visibility/cell_lists.h"

namespace nacre {
namespace {

// Triangles farther from the film's corner than this, in pixels, are ignored: cells are numbered by
// int.
constexpr double kMaxFilmPosition = 1e9;

// A bounding rectangle on the film, in pixels.
using FilmBounds = Imath::Box2d;

FilmBounds BoundsOf(const FilmTriangle& t) {
  FilmBounds bounds;
  for (const Vec2d& corner : t) bounds.extendBy(corner);
  return bounds;
}

// Twice the area, positive if the corners are seen in counter-clockwise order. The film's y axis
// points down.
double SignedArea2(const FilmTriangle& t) { return -(t[1] - t[0]).cross(t[2] - t[0]); }

// The corner at which the longest edge begins, in the order of the corners.
size_t LongestEdge(const FilmTriangle& t) {
  size_t longest = 0;
  for (size_t i = 1; i < 3; ++i) {
    if ((t[(i + 1) % 3] - t[i]).length2() > (t[(longest + 1) % 3] - t[longest]).length2()) {
      longest = i;
    }
  }
  return longest;
}

// A projected triangle of a height of less than kMaxRareWidth over its longest edge.
struct NarrowTriangle {
  FilmTriangle corners;
  size_t longest;  // LongestEdge
  double height;
};

// Returns nullopt if the triangle is not narrow, if a corner is beside or behind the camera, or if
// the projection has no area, so that no ray hits it. `hidden` then says whether no ray can hit the
// triangle.
std::optional<NarrowTriangle> ProjectNarrow(const PrimitiveNumbers& numbers,
                                            const Projector& projector, uint32_t primitive,
                                            bool* hidden) {
  const TriangleRef triangle = TriangleOf(numbers, primitive);
  NarrowTriangle narrow{};
  Vec3d places[3];
  double depths[3];
  for (size_t c = 0; c < 3; ++c) {
    places[c] = triangle.mesh->positions[triangle.Vertex(c)] - numbers.scene->camera.position;
    depths[c] = places[c].dot(projector.forward);
  }
  *hidden = std::max({depths[0], depths[1], depths[2]}) < 0;
  for (size_t c = 0; c < 3; ++c) {
    const Vec3d& place = places[c];
    if (!(depths[c] > 0)) return std::nullopt;
    const FilmPoint at = ProjectPoint(projector, place);
    Vec2d& corner = narrow.corners[c];
    corner = {at.x, at.y};
    if (!(std::abs(corner.x) < kMaxFilmPosition && std::abs(corner.y) < kMaxFilmPosition)) {
      return std::nullopt;
    }
  }
  const double area2 = std::abs(SignedArea2(narrow.corners));
  *hidden = area2 == 0;
  if (!(area2 > 0)) return std::nullopt;
  narrow.longest = LongestEdge(narrow.corners);
  const FilmTriangle& t = narrow.corners;
  narrow.height = area2 / (t[(narrow.longest + 1) % 3] - t[narrow.longest]).length();
  if (!(narrow.height < kMaxRareWidth)) return std::nullopt;
  return narrow;
}

int Columns(const Window& cells) { return cells.width() / kCellSize; }

// Calls emit(column, row) for each cell within whose margin the triangle may lie: the cells that
// its bounding rectangle overlaps, of a long triangle only those near its longest edge.
template <class Emit>
void ForEachCellNear(const SmallTriangles& triangles, const NarrowTriangle& narrow,
                     const Emit& emit) {
  const Window& cells = triangles.cells;
  const FilmBounds box = BoundsOf(narrow.corners);
  const auto place = [&](double at, int from, int count) {
    return static_cast<int>(std::clamp(std::floor((at - from) / kCellSize), -1.0, double(count)));
  };
  const int columns = Columns(cells), rows = cells.height() / kCellSize;
  const int column0 = std::max(place(box.min.x - triangles.margin, cells.x0, columns), 0);
  const int column1 = std::min(place(box.max.x + triangles.margin, cells.x0, columns), columns - 1);
  const int row0 = std::max(place(box.min.y - triangles.margin, cells.y0, rows), 0);
  const int row1 = std::min(place(box.max.y + triangles.margin, cells.y0, rows), rows - 1);
  const Vec2d& from = narrow.corners[narrow.longest];
  const Vec2d along = (narrow.corners[(narrow.longest + 1) % 3] - from).normalized();
  const double nearby = narrow.height + std::sqrt(2.0) * (kCellSize / 2.0 + triangles.margin);
  for (int row = row0; row <= row1; ++row) {
    for (int column = column0; column <= column1; ++column) {
      const Vec2d middle(cells.x0 + (column + 0.5) * kCellSize, cells.y0 + (row + 0.5) * kCellSize);
      if (std::abs(along.cross(middle - from)) <= nearby) emit(column, row);
    }
  }
}

TrianglePiece PieceOf(uint32_t primitive, const FilmTriangle& t, const FilmBounds& bounds) {
  const double area2 = SignedArea2(t);
  const Vec2d size = bounds.size();
  TrianglePiece piece{};
  piece.primitive = primitive;
  piece.front = area2 > 0;
  piece.x = (t[0].x + t[1].x + t[2].x) / 3;
  piece.y = (t[0].y + t[1].y + t[2].y) / 3;
  piece.box = {bounds.center().x, bounds.center().y, size.x / 2, size.y / 2};
  piece.fill = std::abs(area2) / 2 / (size.x * size.y);
  return piece;
}

// Bisects the longest edge until the pieces are narrow in both axes.
template <class Work>
void CutToPieces(uint32_t primitive, const FilmTriangle& t, const FilmBounds& around,
                 const Work& work) {
  const FilmBounds bounds = BoundsOf(t);
  if (!bounds.intersects(around)) return;
  const Vec2d size = bounds.size();
  if (size.x < kMaxRareWidth && size.y < kMaxRareWidth) {
    // Halves of extremely thin triangles may be rounded to no area.
    if (size.x * size.y > 0) work(PieceOf(primitive, t, bounds));
    return;
  }
  const size_t from = LongestEdge(t), to = (from + 1) % 3;
  const Vec2d middle = (t[from] + t[to]) / 2;
  for (const size_t moved : {to, from}) {
    FilmTriangle half = t;
    half[moved] = middle;
    CutToPieces(primitive, half, around, work);
  }
}

}  // namespace

SmallTriangles BinSmallTriangles(const PrimitiveNumbers& numbers, const Projector& projector,
                                 const Window& window, double margin, int threads) {
  SmallTriangles triangles;
  triangles.cells = ExtendToCells(window);
  triangles.margin = margin;
  const Scene& scene = *numbers.scene;
  const size_t count = CountTriangles(scene);
  const int columns = Columns(triangles.cells);
  const size_t cells =
      static_cast<size_t>(columns) * static_cast<size_t>(triangles.cells.height() / kCellSize);
  std::atomic<bool> others = false;
  const auto for_cells = [&](size_t i, const auto& emit) {
    bool hidden = false;
    const auto narrow =
        ProjectNarrow(numbers, projector, static_cast<uint32_t>(scene.spheres.size() + i), &hidden);
    if (!narrow && !hidden) others.store(true, std::memory_order_relaxed);
    if (!narrow) return;
    ForEachCellNear(triangles, *narrow, [&](int column, int row) {
      emit(static_cast<size_t>(row) * static_cast<size_t>(columns) + static_cast<size_t>(column));
    });
  };
  SortIntoCells(
      count, cells, std::numeric_limits<uint32_t>::max() - 1, threads, for_cells, &triangles.end,
      [&](size_t entries) { triangles.primitives = HugeArray<uint32_t>(entries); },
      [&](size_t i, size_t, uint32_t position) {
        triangles.primitives[position] = static_cast<uint32_t>(scene.spheres.size() + i);
      });
  if (triangles.primitives.empty()) triangles.end.clear();
  triangles.no_others = !others;
  return triangles;
}

void ForEachNarrowTriangle(const SmallTriangles& triangles, const PrimitiveNumbers& numbers,
                           const Projector& projector, const Window& cell,
                           const std::function<void(uint32_t, const FilmTriangle&)>& work) {
  if (triangles.end.empty()) return;
  const auto number = [](int pixel) { return static_cast<size_t>(pixel / kCellSize); };
  const size_t list =
      number(cell.y0 - triangles.cells.y0) * static_cast<size_t>(Columns(triangles.cells)) +
      number(cell.x0 - triangles.cells.x0);
  for (size_t i = list == 0 ? 0 : triangles.end[list - 1]; i < triangles.end[list]; ++i) {
    const uint32_t primitive = triangles.primitives[i];
    bool hidden = false;
    const auto narrow = ProjectNarrow(numbers, projector, primitive, &hidden);
    if (narrow) work(primitive, narrow->corners);
  }
}

void ForEachPiece(const SmallTriangles& triangles, const PrimitiveNumbers& numbers,
                  const Projector& projector, const Window& cell,
                  const std::function<void(const TrianglePiece&)>& work) {
  const Vec2d margin(triangles.margin, triangles.margin);
  const FilmBounds around(Vec2d(cell.x0, cell.y0) - margin, Vec2d(cell.x1, cell.y1) + margin);
  ForEachNarrowTriangle(triangles, numbers, projector, cell,
                        [&](uint32_t primitive, const FilmTriangle& corners) {
                          CutToPieces(primitive, corners, around, work);
                        });
}

}  // namespace nacre
