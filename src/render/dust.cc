// SPDX-License-Identifier: Apache-2.0
#include "render/dust.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "render/small_triangles.h"

namespace nacre {
namespace {

// If the patches are a larger share of a pixel than this, samples of the whole pixel do as well.
constexpr double kMostShare = 0.9;

// Each sample is tested against all patches of its pixel. Pixels with more patches are sampled as a
// whole.
constexpr uint32_t kMostPatches = 128;

// A convex polygon on the film, in pixels.
using Polygon = std::vector<Vec2d>;

// The part of the polygon where sign * coordinate <= sign * limit (Sutherland and Hodgman 1974).
void CutPolygon(const Polygon& polygon, int axis, double sign, double limit, Polygon* part) {
  part->clear();
  for (size_t i = 0; i < polygon.size(); ++i) {
    const Vec2d &from = polygon[i], &to = polygon[(i + 1) % polygon.size()];
    const auto beyond = [&](const Vec2d& p) { return sign * ((axis == 0 ? p.x : p.y) - limit); };
    const double before = beyond(from), after = beyond(to);
    if (before <= 0) part->push_back(from);
    if ((before < 0 && after > 0) || (before > 0 && after < 0)) {
      part->push_back(from + (to - from) * (before / (before - after)));
    }
  }
}

// The part of the polygon between two limits along an axis. `room` is a buffer.
void CutBetween(const Polygon& polygon, int axis, double low, double high, Polygon* part,
                Polygon* room) {
  CutPolygon(polygon, axis, -1, low, room);
  CutPolygon(*room, axis, 1, high, part);
}

// Finds the pixels of a cell that may show only dust, and the patches in them.
class DustFinder {
 public:
  DustFinder(const Window& cell, double half_side) : cell_(cell), half_side_(half_side) {}

  void AddSphere(const ProjectedBounds& b) {
    const bool is_small = b.x1 - b.x0 < kMaxRareWidth && b.y1 - b.y0 < kMaxRareWidth;
    const Range rows = Reached(b.y0, b.y1, cell_.y0, cell_.y1);
    const Range columns = Reached(b.x0, b.x1, cell_.x0, cell_.x1);
    for (int y = rows.first; y < rows.end; ++y) {
      const Vec2d height(0, std::min(b.y1, y + after_) - std::max(b.y0, y - before_));
      for (int x = columns.first; x < columns.end; ++x) {
        const Vec2d width(std::min(b.x1, x + after_) - std::max(b.x0, x - before_), 0);
        if (!(width.x > 0 && height.y > 0)) continue;
        if (!is_small) {
          counts_[NumberOf(x, y)] = kMostPatches + 1;
          continue;
        }
        const Vec2d corner(std::max(b.x0, x - before_), std::max(b.y0, y - before_));
        Add(x, y, {corner, {width, height}, false, width.x * height.y});
      }
    }
  }

  void AddTriangle(const FilmTriangle& triangle) {
    whole_.assign(triangle.begin(), triangle.end());
    const auto reached = [&](const Polygon& polygon, int axis, int from, int to) {
      const auto along = [&](const Vec2d& p) { return axis == 0 ? p.x : p.y; };
      const auto [low, high] = std::ranges::minmax_element(polygon, {}, along);
      return Reached(along(*low), along(*high), from, to);
    };
    const Range rows = reached(whole_, 1, cell_.y0, cell_.y1);
    for (int y = rows.first; y < rows.end; ++y) {
      CutBetween(whole_, 1, y - before_, y + after_, &in_row_, &room_);
      if (in_row_.empty()) continue;
      const Range columns = reached(in_row_, 0, cell_.x0, cell_.x1);
      for (int x = columns.first; x < columns.end; ++x) {
        if (counts_[NumberOf(x, y)] > kMostPatches) continue;
        CutBetween(in_row_, 0, x - before_, x + after_, &in_pixel_, &room_);
        for (size_t i = 2; i < in_pixel_.size(); ++i) {
          const Vec2d sides[2] = {in_pixel_[i - 1] - in_pixel_[0], in_pixel_[i] - in_pixel_[0]};
          const double area = std::abs(sides[0].cross(sides[1])) / 2;
          if (area > 0) Add(x, y, {in_pixel_[0], {sides[0], sides[1]}, true, area});
        }
      }
    }
  }

  bool Any() const { return !all_.empty(); }

  // Stores the patches of the pixels, and the shares of the pixels that they cover.
  void Finish(CellDust* dust) {
    std::ranges::stable_sort(all_, {}, &PatchOfPixel::pixel);
    dust->patches.clear();
    size_t next = 0;
    for (uint32_t pixel = 0; pixel < kCellPixels; ++pixel) {
      dust->first_patch[pixel] = static_cast<uint32_t>(dust->patches.size());
      const size_t first = next;
      double area = 0;
      for (; next < all_.size() && all_[next].pixel == pixel; ++next) area += all_[next].patch.area;
      const double share = area / (4 * half_side_ * half_side_);
      if (counts_[pixel] > kMostPatches || share > kMostShare) continue;
      for (size_t i = first; i < next; ++i) dust->patches.push_back(all_[i].patch);
      dust->sampled_share[pixel] = share;
      dust->any = true;
    }
    dust->first_patch[kCellPixels] = static_cast<uint32_t>(dust->patches.size());
  }

 private:
  struct PatchOfPixel {
    uint32_t pixel;
    DustPatch patch;
  };

  struct Range {
    int first, end;
  };

  // The columns, or rows, whose pixels average some of the interval between two film coordinates.
  Range Reached(double low, double high, int from, int to) const {
    const auto number = [&](double at) {
      return static_cast<int>(std::clamp(std::floor(at), double(from), double(to)));
    };
    return {number(low - after_), std::min(number(high + before_) + 1, to)};
  }

  uint32_t NumberOf(int x, int y) const { return PixelAt(x - cell_.x0, y - cell_.y0); }

  void Add(int x, int y, const DustPatch& patch) {
    const uint32_t pixel = NumberOf(x, y);
    if (counts_[pixel] > kMostPatches) return;
    ++counts_[pixel];
    all_.push_back({pixel, patch});
  }

  const Window cell_;
  const double half_side_;
  const double before_ = half_side_ - 0.5, after_ = half_side_ + 0.5;  // from a pixel's number
  uint32_t counts_[kCellPixels] = {};  // more than kMostPatches: sampled as a whole
  std::vector<PatchOfPixel> all_;
  Polygon whole_, in_row_, in_pixel_, room_;  // buffers
};

// The patches that the samples of a pixel are spread over; none for most pixels.
std::span<const DustPatch> PatchesOf(const CellDust& dust, uint32_t pixel) {
  const uint32_t first = dust.first_patch[pixel];
  return {dust.patches.data() + first, dust.first_patch[pixel + 1] - first};
}

// Whether the point lies in the patch, up to rounding.
bool Holds(const DustPatch& patch, const Vec2d& point) {
  constexpr double kRounding = 1e-9;
  const double whole = patch.sides[0].cross(patch.sides[1]);
  const Vec2d from = point - patch.corner;
  const double a = from.cross(patch.sides[1]) / whole, b = patch.sides[0].cross(from) / whole;
  if (!(a > -kRounding && b > -kRounding)) return false;
  return patch.triangle ? a + b < 1 + kRounding : std::max(a, b) < 1 + kRounding;
}

// Maps a point of the unit square to the patch.
Vec2d PointOf(const DustPatch& patch, const Vec2d& u) {
  const bool fold = patch.triangle && u.x + u.y > 1;
  return patch.corner + patch.sides[0] * (fold ? 1 - u.x : u.x) +
         patch.sides[1] * (fold ? 1 - u.y : u.y);
}

}  // namespace

void FindDust(const FramePlan& plan, const Window& cell, const TileShapes& shapes, CellDust* dust) {
  std::fill_n(dust->sampled_share, kCellPixels, 1.0);
  dust->any = false;
  const double half_side = plan.adaptive.dust_half_side;
  const SmallTriangles& triangles = plan.adaptive.small_triangles;
  if (half_side == 0 || (shapes.triangles && !triangles.no_others)) return;
  DustFinder finder(cell, half_side);
  const Projector projector = MakeProjector(plan.camera);
  for (const auto& in_cell : shapes.spheres.cells) {
    for (const TileCandidate& candidate : in_cell) {
      const ProjectedBounds bounds = ProjectClosely(projector, candidate.sphere);
      if (bounds.visible) finder.AddSphere(bounds);
    }
  }
  ForEachNarrowTriangle(
      triangles, plan.surfaces.primitives, projector, cell,
      [&](uint32_t, const FilmTriangle& corners) { finder.AddTriangle(corners); });
  if (finder.Any()) finder.Finish(dust);
}

void MoveToDust(const FramePlan& plan, const Window& cell, std::span<const SampleEntry> list,
                size_t count, FilmBatch* film, CellDust* dust) {
  if (!dust->any) return;
  const double half_side = plan.adaptive.dust_half_side;
  for (size_t entry = 0; entry < list.size(); ++entry) {
    const std::span<const DustPatch> patches = PatchesOf(*dust, list[entry].pixel);
    if (patches.empty()) continue;
    const FilmPixel pixel = PixelOf(cell, list[entry].pixel);
    const Vec2d middle(pixel.x + 0.5, pixel.y + 0.5);
    const double share = dust->sampled_share[list[entry].pixel];
    for (size_t ray = entry * count; ray < (entry + 1) * count; ++ray) {
      const Vec2d u((film->x[ray] - middle.x) / (2 * half_side) + 0.5,
                    (film->y[ray] - middle.y) / (2 * half_side) + 0.5);
      // u.x chooses the patch, in proportion to the areas; its remainder and u.y choose the place
      // in it.
      double area = std::clamp(u.x, 0.0, 1.0) * share * 4 * half_side * half_side;
      size_t chosen = 0;
      for (; chosen + 1 < patches.size() && area >= patches[chosen].area; ++chosen) {
        area -= patches[chosen].area;
      }
      const Vec2d place(std::min(area / patches[chosen].area, 1.0), std::clamp(u.y, 0.0, 1.0));
      const Vec2d point = PointOf(patches[chosen], place);
      double patches_here = 1;
      for (size_t i = 0; i < patches.size(); ++i) {
        patches_here += i != chosen && Holds(patches[i], point);
      }
      dust->sample_share[ray] = share / patches_here;
      film->x[ray] = point.x;
      film->y[ray] = point.y;
    }
  }
}

void WeighDust(double background, std::span<const SampleEntry> list, size_t count,
               const CellDust& dust, double* values) {
  if (!dust.any) return;
  for (size_t entry = 0; entry < list.size(); ++entry) {
    if (dust.sampled_share[list[entry].pixel] == 1) continue;
    const bool empty = PatchesOf(dust, list[entry].pixel).empty();
    for (size_t ray = entry * count; ray < (entry + 1) * count; ++ray) {
      values[ray] =
          empty ? background : background + dust.sample_share[ray] * (values[ray] - background);
    }
  }
}

}  // namespace nacre
