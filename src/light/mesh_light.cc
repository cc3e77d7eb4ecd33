// SPDX-License-Identifier: Apache-2.0
#include "light/mesh_light.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace nacre {
namespace {

constexpr uint32_t kLeafSize = 4;
constexpr double kBoxMargin = 0x1p-50;  // relative to the mesh's size: a few roundings

struct Box {
  Vec3d low{std::numeric_limits<double>::infinity()};
  Vec3d high{-std::numeric_limits<double>::infinity()};

  void Add(const Vec3d& p) {
    for (int c = 0; c < 3; ++c) {
      low[c] = std::min(low[c], p[c]);
      high[c] = std::max(high[c], p[c]);
    }
  }
  void Add(const TriangleLight<double>& t) {
    Add(t.corner);
    Add(t.corner + t.edge_x);
    Add(t.corner + t.edge_y);
  }
};

Vec3d Centroid(const TriangleLight<double>& t) { return t.corner + (t.edge_x + t.edge_y) / 3; }

// Splits the triangles at the median along the longest side of their centroids' box, until few are
// left. Sorts `order`.
class TreeBuilder {
 public:
  TreeBuilder(const std::vector<TriangleLight<double>>& triangles, std::vector<uint32_t>* order,
              std::vector<MeshLightNode>* tree)
      : triangles_(triangles), order_(*order), tree_(*tree) {}

  void Build() {
    tree_.emplace_back();
    Split(0, 0, static_cast<uint32_t>(order_.size()));
    // The margin keeps rays in the plane of a side inside of the box, as SlabInverse requires.
    const Vec3d margin(kBoxMargin * (tree_[0].high - tree_[0].low).length());
    for (MeshLightNode& node : tree_) {
      node.low -= margin;
      node.high += margin;
    }
  }

 private:
  void Split(size_t node, uint32_t begin, uint32_t end) {
    Box box, centroids;
    for (uint32_t i = begin; i < end; ++i) {
      box.Add(triangles_[order_[i]]);
      centroids.Add(Centroid(triangles_[order_[i]]));
    }
    tree_[node] = {box.low, box.high, begin, end, 0};
    if (end - begin <= kLeafSize) return;
    const Vec3d size = centroids.high - centroids.low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const uint32_t half = begin + (end - begin) / 2;
    std::nth_element(order_.begin() + begin, order_.begin() + half, order_.begin() + end,
                     [&](uint32_t a, uint32_t b) {
                       return Centroid(triangles_[a])[axis] < Centroid(triangles_[b])[axis];
                     });
    const auto child = static_cast<uint32_t>(tree_.size());
    tree_[node].child = child;
    tree_.resize(tree_.size() + 2);
    Split(child, begin, half);
    Split(child + 1, half, end);
  }

  const std::vector<TriangleLight<double>>& triangles_;
  std::vector<uint32_t>& order_;
  std::vector<MeshLightNode>& tree_;
};

// The tolerance of corners from a plane, relative to the mesh's size, because files hold floats. A
// step of that height hides parts of the mesh only from points that see it at smaller slopes, which
// get as little light.
constexpr double kFlat = 1e-7;

// The largest and the smallest height of any corner over any triangle's plane, relative to the
// mesh's size.
struct Heights {
  double highest = 0, lowest = 0;
};

Heights FindHeights(const MeshLight& light) {
  Box box;
  for (const auto& triangle : light.triangles) box.Add(triangle);
  const double size = (box.high - box.low).length();
  Heights heights;
  for (const auto& plane : light.triangles) {
    const Vec3d normal = (plane.edge_x % plane.edge_y).normalized();
    for (const auto& t : light.triangles) {
      for (const Vec3d& corner : {t.corner, t.corner + t.edge_x, t.corner + t.edge_y}) {
        const double height = (normal ^ (corner - plane.corner)) / size;
        heights.highest = std::max(heights.highest, height);
        heights.lowest = std::min(heights.lowest, height);
      }
    }
  }
  return heights;
}

// 1 / x, and a large finite number for x = 0: 0 times it is 0.
double SlabInverse(double x) { return x == 0 ? kSlabInfinity : 1 / x; }

// Ize 2013, "Robust BVH Ray Traversal": the far end is multiplied by 1 + 2 gamma(3), so that no box
// is missed because of rounding.
bool IntersectsBox(const MeshLightNode& box, const Vec3d& point, const Vec3d& inverse) {
  double near = 0, far = std::numeric_limits<double>::infinity();
  for (int c = 0; c < 3; ++c) {
    const double a = (box.low[c] - point[c]) * inverse[c];
    const double b = (box.high[c] - point[c]) * inverse[c];
    near = std::max(near, std::min(a, b));
    far = std::min(far, std::max(a, b));
  }
  return near <= far * kSlabRounding;
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
  MeshLight light;
  TreeBuilder(unsorted, &order, &light.tree).Build();
  light.triangles.reserve(order.size());
  light.crosses.reserve(order.size());
  light.probabilities.reserve(order.size());
  double sum = 0;
  for (const uint32_t i : order) {
    light.triangles.push_back(unsorted[i]);
    light.crosses.push_back(unsorted[i].edge_x % unsorted[i].edge_y);
    light.probabilities.push_back(light.crosses.back().length());
    sum += light.probabilities.back();
  }
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
  const Vec3d inverse(SlabInverse(direction.x), SlabInverse(direction.y), SlabInverse(direction.z));
  uint32_t stack[kMeshLightStack];
  size_t size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const MeshLightNode& node = light.tree[stack[--size]];
    if (!IntersectsBox(node, point, inverse)) continue;
    if (node.child != 0) {
      stack[size++] = node.child;
      stack[size++] = node.child + 1;
      continue;
    }
    for (uint32_t i = node.begin; i < node.end; ++i) {
      const double t =
          IntersectLightTriangle(light.triangles[i], light.crosses[i], point, direction);
      if (t > 0) hits->push_back({i, t});
    }
  }
}

}  // namespace nacre
