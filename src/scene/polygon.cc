// SPDX-License-Identifier: Apache-2.0
#include "scene/polygon.h"

#include <cmath>
#include <numeric>
#include <utility>

namespace nacre {
namespace {

// The corners seen along the normal's largest component, counter-clockwise.
std::vector<Vec2d> Flatten(std::span<const Vec3d> corners) {
  const Vec3d normal = NewellNormal(corners);
  int axis = std::abs(normal.x) > std::abs(normal.y) ? 0 : 1;
  if (std::abs(normal.z) > std::abs(normal[axis])) axis = 2;
  int u = (axis + 1) % 3;
  int v = (axis + 2) % 3;
  if (normal[axis] < 0) std::swap(u, v);
  std::vector<Vec2d> flat;
  flat.reserve(corners.size());
  for (const Vec3d& corner : corners) {
    flat.emplace_back(corner[u] - corners[0][u], corner[v] - corners[0][v]);
  }
  return flat;
}

// Twice the signed area of a triangle: positive when a, b, c turn left.
double Turn(const Vec2d& a, const Vec2d& b, const Vec2d& c) { return (b - a).cross(c - a); }

// True if the corner at `i` of what remains is convex and its triangle holds no other corner.
bool IsEar(const std::vector<Vec2d>& flat, const std::vector<uint32_t>& remaining, size_t i) {
  const size_t n = remaining.size();
  const Vec2d& a = flat[remaining[(i + n - 1) % n]];
  const Vec2d& b = flat[remaining[i]];
  const Vec2d& c = flat[remaining[(i + 1) % n]];
  if (!(Turn(a, b, c) > 0)) return false;
  for (const uint32_t other : remaining) {
    const Vec2d& p = flat[other];
    if (p == a || p == b || p == c) continue;  // also corners that touch
    if (Turn(a, b, p) >= 0 && Turn(b, c, p) >= 0 && Turn(c, a, p) >= 0) return false;
  }
  return true;
}

}  // namespace

// Relative to one corner, so that it does not cancel far from the origin.
Vec3d NewellNormal(std::span<const Vec3d> corners) {
  Vec3d sum(0, 0, 0);
  for (size_t i = 2; i < corners.size(); ++i) {
    sum += (corners[i - 1] - corners[0]).cross(corners[i] - corners[0]);
  }
  return sum;
}

void Triangulate(std::span<const Vec3d> corners, std::vector<uint32_t>* triangles) {
  if (corners.size() == 3) {
    // What follows finds that the corner at 1 is an ear, for `Turn` is then the normal's largest
    // component.
    const Vec3d normal = NewellNormal(corners);
    const double size = std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z);
    if (size > 0 && std::isfinite(size)) {
      triangles->insert(triangles->end(), {0, 1, 2});
      return;
    }
  }
  const std::vector<Vec2d> flat = Flatten(corners);
  std::vector<uint32_t> remaining(corners.size());
  std::iota(remaining.begin(), remaining.end(), 0u);
  while (remaining.size() >= 3) {
    // From 1 on, so that a convex polygon becomes a fan around its first corner.
    size_t ear = 1;
    while (ear < remaining.size() && !IsEar(flat, remaining, ear)) ++ear;
    if (ear == remaining.size()) ear = IsEar(flat, remaining, 0) ? 0 : 1;
    const size_t n = remaining.size();
    triangles->insert(triangles->end(),
                      {remaining[(ear + n - 1) % n], remaining[ear], remaining[(ear + 1) % n]});
    remaining.erase(remaining.begin() + static_cast<std::ptrdiff_t>(ear));
  }
}

}  // namespace nacre
