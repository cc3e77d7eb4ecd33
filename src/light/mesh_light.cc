// SPDX-License-Identifier: Apache-2.0
#include "light/mesh_light.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace nacre {
namespace {

constexpr uint32_t kLeafSize = 4;
constexpr double kBoxMargin = 0x1p-50;  // over the mesh's size: some last digits

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

Vec3d Middle(const TriangleLight<double>& t) { return t.corner + (t.edge_x + t.edge_y) / 3; }

// Halves the triangles at the median along the longest side of their middles' box, until few are
// left. Sorts `order`.
class TreeBuilder {
 public:
  TreeBuilder(const std::vector<TriangleLight<double>>& triangles, std::vector<uint32_t>* order,
              std::vector<MeshLightNode>* tree)
      : triangles_(triangles), order_(*order), tree_(*tree) {}

  void Build() {
    tree_.emplace_back();
    Split(0, 0, static_cast<uint32_t>(order_.size()));
    // A ray in the plane of a box's side is in the box: so that it is not asked 0 times infinity.
    const Vec3d margin(kBoxMargin * (tree_[0].high - tree_[0].low).length());
    for (MeshLightNode& node : tree_) {
      node.low -= margin;
      node.high += margin;
    }
  }

 private:
  void Split(size_t node, uint32_t begin, uint32_t end) {
    Box box, middles;
    for (uint32_t i = begin; i < end; ++i) {
      box.Add(triangles_[order_[i]]);
      middles.Add(Middle(triangles_[order_[i]]));
    }
    tree_[node] = {box.low, box.high, begin, end, 0};
    if (end - begin <= kLeafSize) return;
    const Vec3d size = middles.high - middles.low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const uint32_t half = begin + (end - begin) / 2;
    std::nth_element(order_.begin() + begin, order_.begin() + half, order_.begin() + end,
                     [&](uint32_t a, uint32_t b) {
                       return Middle(triangles_[a])[axis] < Middle(triangles_[b])[axis];
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

// How far corners of a plane may be off it, over the mesh's size: files have floats. A step of that
// height hides something from points that see the mesh at slopes below it, which get as little.
constexpr double kFlat = 1e-7;

// The largest height of any corner over a triangle's plane, and the lowest, over the mesh's size.
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

// 1 / x, with a number for infinity, for which 0 times it is one, too.
double SlabInverse(double x) { return x == 0 ? kSlabInfinity : 1 / x; }

// Ize 2013, "Robust BVH Ray Traversal": the far end times 1 + 2 gamma(3), so that no box is missed
// by the rounding of its slabs.
bool MeetsBox(const MeshLightNode& box, const Vec3d& point, const Vec3d& inverse) {
  double near = 0, far = std::numeric_limits<double>::infinity();
  for (int c = 0; c < 3; ++c) {
    const double a = (box.low[c] - point[c]) * inverse[c];
    const double b = (box.high[c] - point[c]) * inverse[c];
    near = std::max(near, std::min(a, b));
    far = std::min(far, std::max(a, b));
  }
  return near <= far * kSlabRounding;
}

// Where the ray meets the triangle's plane in it (Cramer), edges included; 0 if it does not.
double MeetTriangle(const TriangleLight<double>& t, const Vec3d& cross, const Vec3d& point,
                    const Vec3d& direction) {
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
  if (light.triangles.size() <= kMostClosedTriangles) {
    const Heights heights = FindHeights(light);
    light.is_convex = heights.highest <= kFlat;
    light.is_flat = light.is_convex && heights.lowest >= -kFlat;
    if (light.is_convex)
      light.outline = MakeMeshOutline(positions, triangles, origin, light.is_flat);
  }
  return light;
}

void FindMeetings(const MeshLight& light, const Vec3d& point, const Vec3d& direction,
                  std::vector<MeshLightMeeting>* meetings) {
  meetings->clear();
  const Vec3d inverse(SlabInverse(direction.x), SlabInverse(direction.y), SlabInverse(direction.z));
  uint32_t stack[kMeshLightStack];
  size_t size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const MeshLightNode& node = light.tree[stack[--size]];
    if (!MeetsBox(node, point, inverse)) continue;
    if (node.child != 0) {
      stack[size++] = node.child;
      stack[size++] = node.child + 1;
      continue;
    }
    for (uint32_t i = node.begin; i < node.end; ++i) {
      const double t = MeetTriangle(light.triangles[i], light.crosses[i], point, direction);
      if (t > 0) meetings->push_back({i, t});
    }
  }
}

}  // namespace nacre
