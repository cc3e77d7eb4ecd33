// SPDX-License-Identifier: Apache-2.0
#include "scene/polygon.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace nacre {
namespace {

// The corners projected along the normal's largest component, counter-clockwise, relative to the
// first.
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

// Finds ears in what remains of a polygon. For each corner it remembers the first other corner that
// is not known to lie outside its triangle. As long as that one remains and the neighbours are the
// same, the corner is no ear, and those before need not be tested again. n corners take n^2 steps
// at most.
class EarFinder {
 public:
  explicit EarFinder(std::vector<Vec2d> flat)
      : flat_(std::move(flat)), remaining_(flat_.size()), next_other_(flat_.size(), 0) {
    std::iota(remaining_.begin(), remaining_.end(), 0u);
  }
  size_t size() const { return remaining_.size(); }
  // The number of the i-th remaining corner; `i` wraps around.
  uint32_t Corner(size_t i) const { return remaining_[i % size()]; }

  // True if the corner at `i` of what remains is convex and its triangle holds no other corner.
  bool IsEar(size_t i) {
    const Vec2d& a = flat_[Corner(i + size() - 1)];
    const Vec2d& b = flat_[Corner(i)];
    const Vec2d& c = flat_[Corner(i + 1)];
    if (!(Turn(a, b, c) > 0)) return false;
    uint32_t& other = next_other_[Corner(i)];
    for (auto at = std::lower_bound(remaining_.begin(), remaining_.end(), other);
         at != remaining_.end(); ++at) {
      other = *at;
      const Vec2d& p = flat_[other];
      // Most corners lie beyond the edge that the ear would leave, which is therefore tested first.
      if (!(Turn(c, a, p) >= 0 && Turn(a, b, p) >= 0 && Turn(b, c, p) >= 0)) continue;
      if (p != a && p != b && p != c) return false;  // corners at the same point do not count
    }
    return true;
  }

  void Remove(size_t i) {
    next_other_[Corner(i + size() - 1)] = next_other_[Corner(i + 1)] = 0;
    remaining_.erase(remaining_.begin() + static_cast<std::ptrdiff_t>(i));
  }

 private:
  std::vector<Vec2d> flat_;
  std::vector<uint32_t> remaining_;   // in rising order
  std::vector<uint32_t> next_other_;  // by corner: the first that is not known to be outside
};

}  // namespace

// Computed relative to one corner, to avoid cancellation far from the origin.
Vec3d NewellNormal(std::span<const Vec3d> corners) {
  Vec3d sum(0, 0, 0);
  for (size_t i = 2; i < corners.size(); ++i) {
    sum += (corners[i - 1] - corners[0]).cross(corners[i] - corners[0]);
  }
  return sum;
}

void Triangulate(std::span<const Vec3d> corners, std::vector<uint32_t>* triangles) {
  if (corners.size() == 3) {
    // The general case would find that the corner at 1 is an ear, because `Turn` is then the
    // absolute value of the normal's largest component.
    const Vec3d normal = NewellNormal(corners);
    const double size = std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z);
    if (size > 0 && std::isfinite(size)) {
      triangles->insert(triangles->end(), {0, 1, 2});
      return;
    }
  }
  EarFinder ears(Flatten(corners));
  while (ears.size() >= 3) {
    // The search begins at 1, so that a convex polygon becomes a fan around its first corner.
    size_t ear = 1;
    while (ear < ears.size() && !ears.IsEar(ear)) ++ear;
    if (ear == ears.size()) ear = ears.IsEar(0) ? 0 : 1;
    triangles->insert(triangles->end(),
                      {ears.Corner(ear + ears.size() - 1), ears.Corner(ear), ears.Corner(ear + 1)});
    ears.Remove(ear);
  }
}

}  // namespace nacre
