// SPDX-License-Identifier: Apache-2.0
#include "light/mesh_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>

#include <Imath/ImathBox.h>

namespace nacre {
namespace {

std::array<Vec3d, 3> CornersOf(const TriangleLight<double>& t) {
  return {t.corner, t.corner + t.edge_x, t.corner + t.edge_y};
}

Vec3d Centroid(const TriangleLight<double>& t) { return t.corner + (t.edge_x + t.edge_y) / 3; }

// Triangles [begin, end) in sorted order, and their box. A range that is split has its two halves
// at the indices `halves` and `halves` + 1.
struct Range {
  Imath::Box3d box;
  uint32_t begin = 0, end = 0;
  uint32_t halves = 0;  // 0: not split

  uint32_t count() const { return end - begin; }
};

// Splits the triangles at the median along the longest side of their centroids' box, until each
// range has few. Sorts `order`, whose part from `begin` to `end` becomes the range.
void SplitRange(const std::vector<TriangleLight<double>>& triangles, size_t range, uint32_t begin,
                uint32_t end, std::vector<uint32_t>* order, std::vector<Range>* ranges) {
  constexpr uint32_t kFew = 4;
  Imath::Box3d box, centroids;
  for (uint32_t i = begin; i < end; ++i) {
    const TriangleLight<double>& triangle = triangles[(*order)[i]];
    for (const Vec3d& corner : CornersOf(triangle)) box.extendBy(corner);
    centroids.extendBy(Centroid(triangle));
  }
  (*ranges)[range] = {box, begin, end, 0};
  if (end - begin <= kFew) return;
  const Vec3d size = centroids.size();
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const uint32_t middle = begin + (end - begin) / 2;
  std::nth_element(order->begin() + begin, order->begin() + middle, order->begin() + end,
                   [&](uint32_t a, uint32_t b) {
                     return Centroid(triangles[a])[axis] < Centroid(triangles[b])[axis];
                   });
  const auto halves = static_cast<uint32_t>(ranges->size());
  (*ranges)[range].halves = halves;
  ranges->resize(ranges->size() + 2);
  SplitRange(triangles, halves, begin, middle, order, ranges);
  SplitRange(triangles, halves + 1, middle, end, order, ranges);
}

float RoundDown(double x) {
  const auto f = static_cast<float>(x);
  return f <= x ? f : std::nextafter(f, -std::numeric_limits<float>::infinity());
}

// Makes the light's tree: nodes of up to kMeshLightWidth ranges, leaves of up to kMeshLightLeaf
// triangles. The second half of a range always comes before the first: pdfs are summed in the order
// in which rays meet triangles, so the order affects the bits of a picture.
class TreeBuilder {
 public:
  TreeBuilder(const std::vector<Range>& ranges, MeshLight* light)
      : ranges_(ranges), light_(*light) {}

  void Build() { AddNode(ChildrenOf(0)); }

 private:
  uint32_t AddNode(std::span<const uint32_t> children) {
    const auto node = static_cast<uint32_t>(light_.nodes.size());
    light_.nodes.emplace_back();
    light_.nodes[node].count = static_cast<uint32_t>(children.size());
    for (size_t i = 0; i < kMeshLightWidth; ++i) {
      // Unused entries repeat the last child's box.
      SetBox(ranges_[children[std::min(i, children.size() - 1)]].box, i, &light_.nodes[node]);
    }
    for (size_t i = 0; i < children.size(); ++i) {
      const bool leaf = ranges_[children[i]].count() <= kMeshLightLeaf;
      const uint32_t child = leaf ? AddLeaf(children[i]) : AddNode(ChildrenOf(children[i]));
      light_.nodes[node].child[i] = child;
      light_.nodes[node].leaves |= leaf ? 1u << i : 0u;
    }
    return node;
  }

  // Splits the largest range repeatedly until there are kMeshLightWidth, or all are leaves.
  std::vector<uint32_t> ChildrenOf(uint32_t root) const {
    std::vector<uint32_t> children{root};
    while (children.size() < kMeshLightWidth) {
      const auto largest = std::max_element(
          children.begin(), children.end(),
          [&](uint32_t a, uint32_t b) { return ranges_[a].count() < ranges_[b].count(); });
      if (ranges_[*largest].count() <= kMeshLightLeaf) break;
      const uint32_t halves = ranges_[*largest].halves;
      *largest = halves + 1;
      children.insert(largest + 1, halves);
    }
    return children;
  }

  static void SetBox(const Imath::Box3d& box, size_t i, MeshLightNode* node) {
    for (int c = 0; c < 3; ++c) {
      node->low[c][i] = RoundDown(box.min[c]);
      node->high[c][i] = -RoundDown(-box.max[c]);
    }
  }

  uint32_t AddLeaf(uint32_t range) {
    MeshLightLeaf leaf{};
    size_t count = 0;
    FillLeaf(ranges_[range], &leaf, &count);
    light_.leaves.push_back(leaf);
    return static_cast<uint32_t>(light_.leaves.size() - 1);
  }

  void FillLeaf(const Range& range, MeshLightLeaf* leaf, size_t* count) const {
    if (range.halves != 0) {
      FillLeaf(ranges_[range.halves + 1], leaf, count);
      FillLeaf(ranges_[range.halves], leaf, count);
      return;
    }
    for (uint32_t k = range.begin; k < range.end; ++k, ++*count) {
      for (int c = 0; c < 3; ++c) {
        leaf->corner[c][*count] = light_.triangles[k].corner[c];
        leaf->edge_x[c][*count] = light_.triangles[k].edge_x[c];
        leaf->edge_y[c][*count] = light_.triangles[k].edge_y[c];
        leaf->cross[c][*count] = light_.crosses[k][c];
      }
      leaf->triangle[*count] = k;
    }
  }

  const std::vector<Range>& ranges_;
  MeshLight& light_;
};

// The tolerance of corners from a plane, relative to the mesh's size, because files hold floats. A
// step of that height hides parts of the mesh only from points that see it at smaller slopes, which
// receive correspondingly little light.
constexpr double kFlat = 1e-7;

// The largest and the smallest height of any corner over any triangle's plane, relative to the
// mesh's size.
struct Heights {
  double highest = 0, lowest = 0;
};

Heights FindHeights(const MeshLight& light) {
  Imath::Box3d box;
  for (const auto& triangle : light.triangles) {
    for (const Vec3d& corner : CornersOf(triangle)) box.extendBy(corner);
  }
  const double size = box.size().length();
  Heights heights;
  for (const auto& plane : light.triangles) {
    const Vec3d normal = (plane.edge_x % plane.edge_y).normalized();
    for (const auto& t : light.triangles) {
      for (const Vec3d& corner : CornersOf(t)) {
        const double height = (normal ^ (corner - plane.corner)) / size;
        heights.highest = std::max(heights.highest, height);
        heights.lowest = std::min(heights.lowest, height);
      }
    }
  }
  return heights;
}

// The t at which the ray hits the triangle, edges included, by Cramer's rule; 0 if it misses.
double IntersectLightTriangle(const TriangleLight<double>& t, const Vec3d& cross,
                              const Vec3d& point, const Vec3d& direction) {
  const Vec3d corner = t.corner - point;
  const double towards = direction ^ cross;
  if (towards == 0) return 0;
  const double sign = std::copysign(1.0, towards);
  const Vec3d across = corner % direction;
  const double x = (across ^ t.edge_y) * sign;
  const double y = -(across ^ t.edge_x) * sign;
  if (!(x >= 0 && y >= 0 && x + y <= std::abs(towards))) return 0;
  return (corner ^ cross) / towards;
}

}  // namespace

MeshLight MakeMeshLight(std::span<const Vec3d> positions, std::span<const uint32_t> triangles,
                        const Vec3d& origin) {
  std::vector<TriangleLight<double>> unsorted;
  unsorted.reserve(triangles.size() / 3);
  for (size_t i = 0; i + 2 < triangles.size(); i += 3) {
    const Vec3d& corner = positions[triangles[i]];
    const TriangleLight<double> triangle{corner - origin, positions[triangles[i + 1]] - corner,
                                         positions[triangles[i + 2]] - corner};
    if ((triangle.edge_x % triangle.edge_y).length() > 0) unsorted.push_back(triangle);
  }
  std::vector<uint32_t> order(unsorted.size());
  std::iota(order.begin(), order.end(), 0u);
  std::vector<Range> ranges(1);
  SplitRange(unsorted, 0, 0, static_cast<uint32_t>(order.size()), &order, &ranges);
  MeshLight light;
  light.triangles.reserve(order.size());
  light.crosses.reserve(order.size());
  light.probabilities.reserve(order.size());
  double sum = 0;
  for (const uint32_t i : order) {
    light.triangles.push_back(unsorted[i]);
    light.crosses.push_back(unsorted[i].edge_x % unsorted[i].edge_y);
    light.probabilities.push_back(light.crosses.back().length());
    sum += light.probabilities.back();
    for (const Vec3d& corner : CornersOf(unsorted[i])) {
      light.radius = std::max(light.radius, corner.length());
    }
  }
  TreeBuilder(ranges, &light).Build();
  for (double& probability : light.probabilities) probability /= sum;
  light.by_area = MakeInverseCdf(light.probabilities);
  if (light.triangles.size() <= kMaxClosedFormTriangles) {
    const Heights heights = FindHeights(light);
    light.is_convex = heights.highest <= kFlat;
    light.is_flat = light.is_convex && heights.lowest >= -kFlat;
    if (light.is_convex)
      light.outline = MakeMeshOutline(positions, triangles, origin, light.is_flat);
  }
  return light;
}

void FindMeshLightHits(const MeshLight& light, const Vec3d& point, const Vec3d& direction,
                       std::vector<MeshLightHit>* hits) {
  hits->clear();
  for (uint32_t i = 0; i < light.triangles.size(); ++i) {
    const double t = IntersectLightTriangle(light.triangles[i], light.crosses[i], point, direction);
    if (t > 0) hits->push_back({i, t});
  }
}

}  // namespace nacre
