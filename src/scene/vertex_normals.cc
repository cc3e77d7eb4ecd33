// SPDX-License-Identifier: Apache-2.0
// scene/vertex_normals.cc: ComputeNormals(), MendNormals() and FindTwins() of mesh.h. The faces
// around a vertex fall into groups that share a normal there; without creases there is one group.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <tuple>

#include "base/float_mode.h"
#include "base/parallel.h"
#include "scene/mesh.h"

namespace nacre {
namespace {

double AngleBetween(const Vec3d& a, const Vec3d& b) {
  return std::atan2(a.cross(b).length(), a.dot(b));
}

// For each position the number of its place: the lowest index of the positions that count as one
// with it.
std::vector<uint32_t> FindPlaces(const Mesh& mesh) {
  if (!mesh.uvs.empty()) return FindTwins(mesh.positions);
  std::vector<uint32_t> place(mesh.positions.size());
  std::iota(place.begin(), place.end(), 0u);
  return place;
}

// What the face of `corner` (an index into Mesh::triangles), whose normal is `face`, contributes to
// the normal at the corner.
Vec3d Contribution(const Mesh& mesh, NormalWeighting weighting, size_t corner, const Vec3d& face) {
  const size_t triangle = corner / 3;
  const auto position = [&](size_t k) -> const Vec3d& {
    return mesh.positions[mesh.triangles[3 * triangle + (corner + k) % 3]];
  };
  const Vec3d to_next = position(1) - position(0), to_last = position(2) - position(0);
  switch (weighting) {
    case NormalWeighting::kAngle:
      return face * AngleBetween(to_next, to_last);
    case NormalWeighting::kArea:
      return face * to_next.cross(to_last).length();
    case NormalWeighting::kUniform:
      break;
  }
  return face;
}

// Calls add(corner, contribution) for all corners in their order. The contributions are computed
// block by block, on several threads.
template <class Add>
void AddContributions(const Mesh& mesh, NormalWeighting weighting, int threads, const Add& add) {
  constexpr size_t kBlock = size_t{1} << 12, kBlocks = 16;  // triangles; blocks at a time
  const size_t triangles = mesh.triangles.size() / 3;
  std::vector<Vec3d> found(3 * std::min(triangles, kBlock * kBlocks));
  for (size_t first = 0; first < triangles; first += kBlock * kBlocks) {
    const size_t end = std::min(triangles, first + kBlock * kBlocks);
    ParallelForBlocks(end - first, kBlock, threads, [&](size_t begin, size_t block_end) {
      const DefaultFloatMode mode;  // meshes may be as small as denormals
      for (size_t i = first + begin; i < first + block_end; ++i) {
        const Vec3d face = FaceNormal(mesh, i);
        for (size_t corner = 3 * i; corner < 3 * i + 3; ++corner) {
          found[corner - 3 * first] = Contribution(mesh, weighting, corner, face);
        }
      }
    });
    for (size_t corner = 3 * first; corner < 3 * end; ++corner)
      add(corner, found[corner - 3 * first]);
  }
}

// Groups of corners that share a normal, as a union-find forest: each corner leads to another one
// of its group, the last one to itself.
class Groups {
 public:
  explicit Groups(size_t corners) : parent_(corners) {
    std::iota(parent_.begin(), parent_.end(), size_t{0});
  }
  size_t Find(size_t corner) {
    while (parent_[corner] != corner) {
      parent_[corner] = parent_[parent_[corner]];
      corner = parent_[corner];
    }
    return corner;
  }
  void Join(size_t a, size_t b) {
    a = Find(a);
    b = Find(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<size_t> parent_;
};

// One end of an edge of a triangle.
struct EdgeEnd {
  uint32_t place, other;  // of this end, and of the edge's other end
  size_t corner;          // of the triangle, at this end
  bool operator<(const EdgeEnd& b) const {
    return std::tie(place, other, corner) < std::tie(b.place, b.other, b.corner);
  }
};

std::vector<EdgeEnd> ListEdgeEnds(const Mesh& mesh, const std::vector<uint32_t>& place) {
  std::vector<EdgeEnd> ends;
  ends.reserve(2 * mesh.triangles.size());
  for (size_t corner = 0; corner < mesh.triangles.size(); ++corner) {
    const size_t first = corner - corner % 3;
    const uint32_t here = place[mesh.triangles[corner]];
    ends.push_back({here, place[mesh.triangles[first + (corner + 1) % 3]], corner});
    ends.push_back({here, place[mesh.triangles[first + (corner + 2) % 3]], corner});
  }
  std::sort(ends.begin(), ends.end());
  return ends;
}

// Joins corners over edges that are no creases. An edge of a triangle without area is never a
// crease.
Groups GroupOverEdges(const Mesh& mesh, const std::vector<uint32_t>& place,
                      double crease_angle_deg) {
  Groups groups(mesh.triangles.size());
  const double crease_angle = crease_angle_deg * (std::numbers::pi / 180);
  const std::vector<EdgeEnd> ends = ListEdgeEnds(mesh, place);
  for (size_t i = 1; i < ends.size(); ++i) {
    const EdgeEnd &a = ends[i - 1], &b = ends[i];
    if (a.place != b.place || a.other != b.other) continue;
    const Vec3d n = FaceNormal(mesh, a.corner / 3), m = FaceNormal(mesh, b.corner / 3);
    const bool has_area = n != Vec3d(0, 0, 0) && m != Vec3d(0, 0, 0);
    if (has_area && AngleBetween(n, m) > crease_angle) continue;
    groups.Join(a.corner, b.corner);
  }
  return groups;
}

// Repeats positions so that no two groups share one; returns each position's group, or kNoGroup.
constexpr size_t kNoGroup = static_cast<size_t>(-1);
std::vector<size_t> SplitPositions(Groups* groups, Mesh* mesh) {
  std::vector<size_t> order(mesh->triangles.size());
  std::iota(order.begin(), order.end(), size_t{0});
  const std::vector<uint32_t> whole = mesh->triangles;
  std::sort(order.begin(), order.end(), [&](size_t a, size_t b) {
    return std::make_tuple(whole[a], groups->Find(a), a) <
           std::make_tuple(whole[b], groups->Find(b), b);
  });
  std::vector<size_t> group_of(mesh->positions.size(), kNoGroup);
  uint32_t vertex = 0;  // the copy that corners of the current group get
  for (size_t i = 0; i < order.size(); ++i) {
    const uint32_t original = whole[order[i]];
    const size_t group = groups->Find(order[i]);
    if (i == 0 || whole[order[i - 1]] != original) {
      vertex = original;
    } else if (group_of[vertex] != group) {
      vertex = static_cast<uint32_t>(mesh->positions.size());
      mesh->positions.push_back(Vec3d(mesh->positions[original]));
      if (!mesh->uvs.empty()) mesh->uvs.push_back(Vec2d(mesh->uvs[original]));
      if (!mesh->second_uvs.empty()) mesh->second_uvs.push_back(Vec2d(mesh->second_uvs[original]));
      if (!mesh->colors.empty()) mesh->colors.push_back(Vec3f(mesh->colors[original]));
      if (!mesh->opacities.empty()) mesh->opacities.push_back(float{mesh->opacities[original]});
      group_of.push_back(group);
    }
    group_of[vertex] = group;
    mesh->triangles[order[i]] = vertex;
  }
  return group_of;
}

}  // namespace

std::vector<uint32_t> FindTwins(const std::vector<Vec3d>& positions) {
  const auto key = [&](uint32_t i) {
    return std::make_tuple(positions[i].x, positions[i].y, positions[i].z, i);
  };
  std::vector<uint32_t> order(positions.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return key(a) < key(b); });
  std::vector<uint32_t> twins(positions.size());
  for (size_t k = 0; k < order.size(); ++k) {
    const bool same = k > 0 && positions[order[k]] == positions[order[k - 1]];
    twins[order[k]] = same ? twins[order[k - 1]] : order[k];
  }
  return twins;
}

Vec3d UnitOrUp(const Vec3d& sum) {
  const Vec3d normal = sum.normalized();
  return normal == Vec3d(0, 0, 0) ? Vec3d(0, 1, 0) : normal;
}

void ComputeNormals(NormalWeighting weighting, double crease_angle_deg, Mesh* mesh, int threads) {
  mesh->tangents.clear();
  std::vector<uint32_t> place = FindPlaces(*mesh);
  std::vector<Vec3d> sums(mesh->positions.size(), Vec3d(0, 0, 0));
  if (crease_angle_deg >= 180) {
    AddContributions(*mesh, weighting, threads, [&](size_t corner, const Vec3d& contribution) {
      sums[place[mesh->triangles[corner]]] += contribution;
    });
    mesh->normals.resize(mesh->positions.size());
    for (size_t i = 0; i < place.size(); ++i) mesh->normals[i] = UnitOrUp(sums[place[i]]);
    return;
  }
  Groups groups = GroupOverEdges(*mesh, place, crease_angle_deg);
  sums.assign(mesh->triangles.size(), Vec3d(0, 0, 0));
  AddContributions(*mesh, weighting, threads, [&](size_t corner, const Vec3d& contribution) {
    sums[groups.Find(corner)] += contribution;
  });
  const std::vector<size_t> group_of = SplitPositions(&groups, mesh);
  mesh->normals.assign(mesh->positions.size(), Vec3d(0, 1, 0));
  for (size_t i = 0; i < group_of.size(); ++i) {
    if (group_of[i] != kNoGroup) mesh->normals[i] = UnitOrUp(sums[group_of[i]]);
  }
}

void MendNormals(Mesh* mesh) {
  const auto is_unit = [](const Vec3d& normal) { return std::abs(normal.length() - 1) < 1e-6; };
  if (std::all_of(mesh->normals.begin(), mesh->normals.end(), is_unit)) return;
  const std::vector<Vec3d> given = std::move(mesh->normals);
  ComputeNormals(NormalWeighting::kAngle, 180, mesh);
  for (size_t i = 0; i < given.size(); ++i) {
    if (is_unit(given[i])) mesh->normals[i] = given[i];
  }
}

}  // namespace nacre
