// SPDX-License-Identifier: Apache-2.0
#include "visibility/shell_tree.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

namespace nacre {
namespace {

// With fewer nested spheres, testing all of them takes too little time to matter. (If the splits of
// AreNested happen to divide a nested group, up to eight times as many may go unnoticed.)
constexpr size_t kFewestNested = 128;
// The size of the sample that decides, and the least number of nested spheres in it.
constexpr size_t kNestedSample = 4096;
constexpr size_t kFewestSampled = 8;

constexpr size_t kLeafSpheres = 4;
// Groups are split in the middle of their widest dimension, which separates outliers at once. Below
// this depth they are split into equal halves, so that the depth is bounded.
constexpr int kMaxMiddleSplits = 60;
static_assert(kMaxMiddleSplits + 32 < kMaxShellDepth);

// A sphere as a point in four dimensions: the spheres of a group that is small in all of them have
// nearly the same surface.
struct SpherePoint {
  double at[4];  // x, y, z, radius
  uint32_t index;
};

struct PointBounds {
  double low[4], high[4];

  int Widest(int dimensions = 4) const {
    int widest = 0;
    for (int i = 1; i < dimensions; ++i) {
      if (high[i] - low[i] > high[widest] - low[widest]) widest = i;
    }
    return widest;
  }
};

SpherePoint PointOf(const HugeArray<TraceSphere>& spheres, size_t index) {
  const auto& [center, radius] = spheres[index];
  return {{center.x, center.y, center.z, radius}, static_cast<uint32_t>(index)};
}

PointBounds PointBoundsOf(std::span<const SpherePoint> points) {
  PointBounds bounds;
  std::fill_n(bounds.low, 4, std::numeric_limits<double>::infinity());
  std::fill_n(bounds.high, 4, -std::numeric_limits<double>::infinity());
  for (const SpherePoint& point : points) {
    for (int i = 0; i < 4; ++i) {
      bounds.low[i] = std::min(bounds.low[i], point.at[i]);
      bounds.high[i] = std::max(bounds.high[i], point.at[i]);
    }
  }
  return bounds;
}

double MiddleOf(const PointBounds& bounds, int i) {
  return bounds.low[i] + (bounds.high[i] - bounds.low[i]) / 2;
}

Shell ShellOf(std::span<const SpherePoint> points, const PointBounds& bounds) {
  Shell shell;
  for (int i = 0; i < 3; ++i) shell.center[i] = MiddleOf(bounds, i);
  shell.inner = std::numeric_limits<double>::infinity();
  for (const SpherePoint& point : points) {
    const Vec3d center(point.at[0], point.at[1], point.at[2]);
    const double distance = (center - shell.center).length();
    shell.inner = std::min(shell.inner, point.at[3] - distance);
    shell.outer = std::max(shell.outer, point.at[3] + distance);
  }
  return shell;
}

// Partitions the points along dimension i into two groups, neither of which is empty; returns the
// size of the first.
size_t SplitGroup(std::span<SpherePoint> points, int i, double middle, int depth) {
  if (depth < kMaxMiddleSplits) {
    const auto end = std::partition(points.begin(), points.end(),
                                    [&](const SpherePoint& p) { return p.at[i] <= middle; });
    if (end != points.begin() && end != points.end()) {
      return static_cast<size_t>(end - points.begin());
    }
  }
  const size_t half = points.size() / 2;
  std::nth_element(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(half), points.end(),
                   [&](const SpherePoint& a, const SpherePoint& b) { return a.at[i] < b.at[i]; });
  return half;
}

// Whether at least `fewest` of the spheres contain a common point. Groups are split by radius
// first, so that a small sphere does not hide that large ones are nested.
bool HasNested(std::span<SpherePoint> points, size_t fewest, int depth) {
  if (points.size() < fewest) return false;
  const PointBounds bounds = PointBoundsOf(points);
  const Shell shell = ShellOf(points, bounds);
  if (shell.inner > 0) return true;
  const bool by_radius = bounds.high[3] > 2 * bounds.low[3];
  const int i = by_radius ? 3 : bounds.Widest(3);
  const double middle =
      by_radius ? std::sqrt(bounds.low[3]) * std::sqrt(bounds.high[3]) : MiddleOf(bounds, i);
  const size_t first = SplitGroup(points, i, middle, depth);
  return HasNested(points.first(first), fewest, depth + 1) ||
         HasNested(points.subspan(first), fewest, depth + 1);
}

void AddMembers(std::span<const SpherePoint> points, bool coincide, ShellTree* tree) {
  for (const SpherePoint& point : points) {
    if (coincide && &point != points.data()) {
      ShellMember& member = tree->members.back();
      member.lowest = std::min(member.lowest, point.index);
      member.highest = std::max(member.highest, point.index);
    } else {
      tree->members.push_back({point.index, point.index});
    }
  }
}

void FillNode(std::span<SpherePoint> points, size_t node, int depth, ShellTree* tree) {
  const PointBounds bounds = PointBoundsOf(points);
  const int widest = bounds.Widest();
  const bool coincide = bounds.low[widest] == bounds.high[widest];
  const bool leaf = coincide || points.size() <= kLeafSpheres;
  const size_t first = leaf ? tree->members.size() : tree->nodes.size();
  tree->nodes[node] = {ShellOf(points, bounds), static_cast<uint32_t>(first), 0};
  if (leaf) {
    AddMembers(points, coincide, tree);
    tree->nodes[node].count = static_cast<uint32_t>(tree->members.size() - first);
    return;
  }
  tree->nodes.resize(first + 2);
  const size_t size = SplitGroup(points, widest, MiddleOf(bounds, widest), depth);
  FillNode(points.first(size), first, depth + 1, tree);
  FillNode(points.subspan(size), first + 1, depth + 1, tree);
}

}  // namespace

bool AreNested(const HugeArray<TraceSphere>& spheres) {
  const size_t count = spheres.size();
  if (count < kFewestNested) return false;
  std::vector<SpherePoint> sample;
  const size_t size = std::min(count, kNestedSample);
  sample.reserve(size);
  for (size_t i = 0; i < size; ++i) {
    // Indices go in steps of the golden ratio, because the order of spheres in a scene may have any
    // period.
    const uint64_t index = size == count ? i : ((i * 0x9e3779b97f4a7c15u >> 32) * count) >> 32;
    sample.push_back(PointOf(spheres, index));
  }
  return HasNested(sample, std::max(kFewestNested * size / count, kFewestSampled), 0);
}

ShellTree BuildShellTree(const HugeArray<TraceSphere>& spheres) {
  std::vector<SpherePoint> points;
  points.reserve(spheres.size());
  for (size_t i = 0; i < spheres.size(); ++i) points.push_back(PointOf(spheres, i));
  ShellTree tree;
  if (points.empty()) return tree;
  tree.nodes.resize(1);
  FillNode(points, 0, 0, &tree);
  return tree;
}

}  // namespace nacre
