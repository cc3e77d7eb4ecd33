// SPDX-License-Identifier: Apache-2.0
#include "scene/tangents.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "base/parallel.h"
#include "scene/mesh.h"
#include "scene/pair_edges.h"

namespace nacre {
namespace {

constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();
constexpr size_t kWorkBlock = size_t{1} << 13;  // triangles or groups that a thread takes at once

template <class Body>
void ForEachInParallel(size_t count, int threads, const Body& body) {
  ParallelForBlocks(count, kWorkBlock, threads, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) body(i);
  });
}

// dP/du' and dP/dv' as combinations of dP/du and dP/dv: the columns of the inverse of `rows`, up to
// a positive factor. `hand` is -1 where `rows` mirrors, 0 if it is singular.
struct UvRotation {
  double hand;
  Vec2d along_u, along_v;  // components along u and v
};

UvRotation UvRotationOf(const UvRows& rows) {
  const auto& [a, b] = rows;
  const double determinant = a.x * b.y - a.y * b.x;
  const double hand = determinant > 0 ? 1 : determinant < 0 ? -1 : 0;
  return {hand, Vec2d(b.y, -b.x) * hand, Vec2d(-a.y, a.x) * hand};
}

class TangentMaker {
 public:
  TangentMaker(const Mesh& mesh, const std::vector<Vec2d>& uvs, const UvRows& rows, int threads)
      : mesh_(mesh),
        uvs_(uvs),
        rotation_(UvRotationOf(rows)),
        threads_(threads),
        smooth_(HasSmoothNormals(mesh)),
        triangle_count_(mesh.triangles.size() / 3) {}

  CornerTangents Make() {
    if (!smooth_) FindFaceNormals();
    WeldVertices();
    FindFaces();
    FindNeighbours();
    FindGroups();
    return AverageGroups();
  }

 private:
  // Texture-space data of a triangle.
  struct Face {
    Vec3d along_u{0, 0, 0};     // unit, or 0
    bool is_degenerate = true;  // two positions are equal, so that no ray hits it
    bool has_no_area = true;    // in texture space
    bool is_upright = false;    // u', v' and the triangle have the same orientation
  };

  const Vec3d& Position(size_t corner) const { return mesh_.positions[mesh_.triangles[corner]]; }
  const Vec3d& Normal(size_t corner) const {
    return smooth_ ? mesh_.normals[mesh_.triangles[corner]] : face_normals_[corner / 3];
  }

  void FindFaceNormals() {
    face_normals_.resize(triangle_count_);
    ForEachInParallel(triangle_count_, threads_,
                      [&](size_t i) { face_normals_[i] = FaceNormal(mesh_, i); });
  }

  // Gives the same number to corners whose positions, normals and coordinates are all equal.
  void WeldVertices() {
    // With smooth normals, which belong to vertices, vertices are compared; else corners.
    const size_t count = smooth_ ? mesh_.positions.size() : mesh_.triangles.size();
    using Key = std::array<double, 8>;
    const auto key_of = [&](size_t i) {
      const size_t vertex = smooth_ ? i : mesh_.triangles[i];
      const Vec3d& p = mesh_.positions[vertex];
      const Vec3d& n = smooth_ ? mesh_.normals[vertex] : face_normals_[i / 3];
      const Vec2d& uv = uvs_[vertex];
      Key key = {p.x, p.y, p.z, n.x, n.y, n.z, uv.x, uv.y};
      for (double& value : key) value += 0.0;  // -0 is 0
      return key;
    };
    const auto hash_of = [](const Key& key) {
      uint64_t hash = 0;
      for (const double value : key) {
        hash = (hash ^ std::bit_cast<uint64_t>(value)) * 0x9e3779b97f4a7c15u;
        hash ^= hash >> 32;
      }
      return hash;
    };
    const size_t slots = std::bit_ceil(2 * count + 1);
    std::vector<uint32_t> table(slots, kNone);
    std::vector<uint32_t> first(count);  // the first one that is equal
    for (size_t i = 0; i < count; ++i) {
      const Key key = key_of(i);
      size_t slot = hash_of(key) & (slots - 1);
      while (table[slot] != kNone && key_of(table[slot]) != key) slot = (slot + 1) & (slots - 1);
      if (table[slot] == kNone) table[slot] = static_cast<uint32_t>(i);
      first[i] = table[slot];
    }
    vertices_.resize(mesh_.triangles.size());
    for (size_t corner = 0; corner < vertices_.size(); ++corner) {
      vertices_[corner] = first[smooth_ ? mesh_.triangles[corner] : corner];
    }
    vertex_count_ = count;
  }

  void FindFaces() {
    faces_.resize(triangle_count_);
    ForEachInParallel(triangle_count_, threads_, [&](size_t i) {
      Face& face = faces_[i];
      const Vec3d &a = Position(3 * i), &b = Position(3 * i + 1), &c = Position(3 * i + 2);
      face.is_degenerate = a == b || a == c || b == c;
      const Vec2d& uv = uvs_[mesh_.triangles[3 * i]];
      const Vec2d b_uv = uvs_[mesh_.triangles[3 * i + 1]] - uv;
      const Vec2d c_uv = uvs_[mesh_.triangles[3 * i + 2]] - uv;
      const double area = b_uv.x * c_uv.y - b_uv.y * c_uv.x;
      // dP/du and dP/dv times the area's absolute value.
      const double side = area > 0 ? 1 : -1;
      const Vec3d by_u = ((b - a) * c_uv.y - (c - a) * b_uv.y) * side;
      const Vec3d by_v = ((c - a) * b_uv.x - (b - a) * c_uv.x) * side;
      const Vec3d along_u = by_u * rotation_.along_u.x + by_v * rotation_.along_u.y;
      const Vec3d along_v = by_u * rotation_.along_v.x + by_v * rotation_.along_v.y;
      face.is_upright = area * rotation_.hand > 0;
      face.has_no_area = area * rotation_.hand == 0 || along_u == Vec3d(0) || along_v == Vec3d(0);
      if (!face.has_no_area) face.along_u = along_u.normalized();
    });
  }

  // Edge k of a triangle goes from its corner k to the next one. Its neighbour is the triangle that
  // has the same edge in the opposite direction. Several triangles on one edge are paired in
  // ascending order.
  void FindNeighbours() {
    struct Edge {
      uint32_t high;  // the vertex at its end with the higher number
      uint32_t corner;
    };
    const auto ends_of = [&](size_t corner) {
      const size_t next = corner % 3 == 2 ? corner - 2 : corner + 1;
      return std::make_pair(vertices_[corner], vertices_[next]);
    };
    std::vector<uint32_t> begin(vertex_count_ + 1);  // the first edge by the edges' lower vertex
    const auto for_each_edge = [&](const auto& body) {
      for (size_t corner = 0; corner < vertices_.size(); ++corner) {
        if (faces_[corner / 3].is_degenerate) continue;
        const auto [from, to] = ends_of(corner);
        body(std::min(from, to), std::max(from, to), static_cast<uint32_t>(corner));
      }
    };
    for_each_edge([&](uint32_t low, uint32_t, uint32_t) { ++begin[low + 1]; });
    for (size_t i = 1; i < begin.size(); ++i) begin[i] += begin[i - 1];
    std::vector<Edge> edges(begin.back());
    std::vector<uint32_t> next = begin;
    for_each_edge([&](uint32_t low, uint32_t high, uint32_t corner) {
      edges[next[low]++] = {high, corner};
    });
    neighbours_.assign(vertices_.size(), kNone);
    for (size_t vertex = 0; vertex < vertex_count_; ++vertex) {
      Edge* const first = edges.data() + begin[vertex];
      Edge* const last = edges.data() + begin[vertex + 1];
      std::sort(first, last, [](const Edge& a, const Edge& b) {
        return std::make_pair(a.high, a.corner) < std::make_pair(b.high, b.corner);
      });
      for (const Edge* edge = first; edge < last;) {
        const Edge* end = edge;
        while (end < last && end->high == edge->high) ++end;
        PairEdges(
            static_cast<size_t>(end - edge),
            [&](size_t i) { return ends_of(edge[i].corner).first < edge->high; },
            [&](size_t up, size_t down) {
              neighbours_[edge[up].corner] = edge[down].corner / 3;
              neighbours_[edge[down].corner] = edge[up].corner / 3;
            });
        edge = end;
      }
    }
  }

  void FindGroups() {
    groups_.assign(vertices_.size(), kNone);
    std::vector<uint32_t> waiting;  // triangles that may belong to the group
    for (size_t corner = 0; corner < vertices_.size(); ++corner) {
      const Face& face = faces_[corner / 3];
      if (face.is_degenerate || face.has_no_area || groups_[corner] != kNone) continue;
      const auto group = static_cast<uint32_t>(group_is_upright_.size());
      const bool is_upright = face.is_upright;
      group_is_upright_.push_back(is_upright);
      waiting.push_back(static_cast<uint32_t>(corner / 3));
      while (!waiting.empty()) {
        const size_t triangle = waiting.back();
        waiting.pop_back();
        const size_t own = Join(triangle, vertices_[corner], group, is_upright);
        if (own == kNone) continue;
        const size_t before = own == 3 * triangle ? own + 2 : own - 1;
        for (const size_t edge : {before, own}) {
          if (neighbours_[edge] != kNone) waiting.push_back(neighbours_[edge]);
        }
      }
    }
  }

  // Adds the triangle's corner at the vertex to the group and returns the corner; returns kNone if
  // the corner belongs to a group already, or if the triangle has the other orientation.
  size_t Join(size_t triangle, uint32_t vertex, uint32_t group, bool is_upright) {
    const size_t first = 3 * triangle;
    size_t own = first;
    while (vertices_[own] != vertex) ++own;
    if (groups_[own] != kNone) return kNone;
    Face& face = faces_[triangle];
    if (face.has_no_area && groups_[first] == kNone && groups_[first + 1] == kNone &&
        groups_[first + 2] == kNone) {
      face.is_upright = is_upright;
    }
    if (face.is_upright != is_upright) return kNone;
    groups_[own] = group;
    return own;
  }

  CornerTangents AverageGroups() {
    const size_t count = group_is_upright_.size();
    std::vector<uint32_t> begin(count + 1);
    for (const uint32_t group : groups_) {
      if (group != kNone) ++begin[group + 1];
    }
    for (size_t i = 1; i < begin.size(); ++i) begin[i] += begin[i - 1];
    std::vector<uint32_t> members(begin.back());
    std::vector<uint32_t> next = begin;
    for (size_t corner = 0; corner < groups_.size(); ++corner) {
      if (groups_[corner] != kNone)
        members[next[groups_[corner]]++] = static_cast<uint32_t>(corner);
    }
    CornerTangents made;
    made.tangents.resize(count + 1, Tangent{Vec3d(0), 1});  // the last one stands for none
    ForEachInParallel(count, threads_, [&](size_t group) {
      Vec3d sum(0, 0, 0);
      for (uint32_t i = begin[group]; i < begin[group + 1]; ++i) sum += Share(members[i]);
      made.tangents[group] = {sum.normalized(), group_is_upright_[group] ? 1.0 : -1.0};
    });
    made.corners = std::move(groups_);
    for (uint32_t& group : made.corners) group = std::min(group, static_cast<uint32_t>(count));
    return made;
  }

  // What a corner adds to its group's tangent.
  Vec3d Share(size_t corner) const {
    const Face& face = faces_[corner / 3];
    if (face.has_no_area) return Vec3d(0);
    const Vec3d& normal = Normal(corner);
    const auto across = [&](const Vec3d& v) { return (v - normal * normal.dot(v)).normalized(); };
    const size_t first = corner - corner % 3;
    const Vec3d& here = Position(corner);
    const Vec3d to_last = across(Position(first + (corner + 2) % 3) - here);
    const Vec3d to_next = across(Position(first + (corner + 1) % 3) - here);
    return across(face.along_u) * std::acos(std::clamp(to_last.dot(to_next), -1.0, 1.0));
  }

  const Mesh& mesh_;
  const std::vector<Vec2d>& uvs_;
  const UvRotation rotation_;
  const int threads_;
  const bool smooth_;
  const size_t triangle_count_;
  std::vector<Vec3d> face_normals_;  // only of meshes without smooth normals
  size_t vertex_count_ = 0;
  std::vector<uint32_t> vertices_;    // by corner
  std::vector<Face> faces_;           // by triangle
  std::vector<uint32_t> neighbours_;  // triangles, by the edge from a corner to the next one
  std::vector<uint32_t> groups_;      // by corner
  std::vector<bool> group_is_upright_;
};

}  // namespace

UvRows RowsOfSameTangents(const UvRows& rows) {
  const double hand = UvRotationOf(rows).hand;
  const double length = rows.v_row.length();
  if (hand == 0 || length == 0) return {Vec2d(0, 0), Vec2d(0, 0)};
  const Vec2d v_row = rows.v_row / length;
  return {Vec2d(v_row.y, -v_row.x) * hand, v_row};
}

CornerTangents MakeTangents(const Mesh& mesh, const std::vector<Vec2d>& uvs, const UvRows& rows,
                            int threads) {
  return TangentMaker(mesh, uvs, rows, threads).Make();
}

CornerTangents RotateTangents(const Mesh& mesh, const UvRows& rows) {
  CornerTangents rotated{mesh.triangles, mesh.tangents};
  const UvRotation rotation = UvRotationOf(rows);
  if (rotation.hand > 0 && rotation.along_u.y == 0) return rotated;
  for (size_t i = 0; i < rotated.tangents.size(); ++i) {
    auto& [direction, sign] = rotated.tangents[i];
    const Vec3d bitangent = mesh.normals[i].cross(direction) * sign;
    direction = (direction * rotation.along_u.x + bitangent * rotation.along_u.y).normalized();
    if (rotation.hand < 0) sign = -sign;
  }
  return rotated;
}

}  // namespace nacre
