// SPDX-License-Identifier: Apache-2.0
#include "light/mesh_outline.h"

#include <algorithm>
#include <array>
#include <map>
#include <tuple>
#include <utility>

namespace nacre {
namespace {

using Corners = std::array<uint32_t, 3>;

// Pairs up the triangles' edges. Returns false if two triangles have an edge in the same direction.
bool FindEdges(const std::vector<Corners>& faces, std::vector<OutlineEdge>* edges) {
  std::map<std::pair<uint32_t, uint32_t>, uint32_t> left;
  for (size_t i = 0; i < faces.size(); ++i) {
    for (size_t k = 0; k < 3; ++k) {
      const std::pair edge(faces[i][k], faces[i][(k + 1) % 3]);
      if (!left.try_emplace(edge, static_cast<uint32_t>(i)).second) return false;
    }
  }
  edges->reserve(left.size());
  for (const auto& [edge, face] : left) {
    const auto other = left.find({edge.second, edge.first});
    if (other == left.end()) {
      edges->push_back({edge.first, edge.second, face, kNoFace});
    } else if (edge.first < edge.second) {
      edges->push_back({edge.first, edge.second, face, other->second});
    }
  }
  return true;
}

// The number of connected components of the faces (union-find).
size_t CountPieces(const MeshOutline& outline) {
  std::vector<uint32_t> piece(outline.faces.size());
  for (uint32_t i = 0; i < piece.size(); ++i) piece[i] = i;
  const auto root = [&](uint32_t i) {
    while (piece[i] != i) i = piece[i] = piece[piece[i]];
    return i;
  };
  size_t pieces = piece.size();
  for (const OutlineEdge& edge : outline.edges) {
    if (edge.right == kNoFace) continue;
    const uint32_t a = root(edge.left), b = root(edge.right);
    pieces -= a == b ? 0 : 1;
    piece[a] = b;
  }
  return pieces;
}

// Tests by Euler's formula whether the faces enclose one ball exactly once, without a hole.
bool IsSolid(const MeshOutline& outline) {
  const auto closed = [](const OutlineEdge& edge) { return edge.right != kNoFace; };
  return std::all_of(outline.edges.begin(), outline.edges.end(), closed) &&
         outline.corners.size() + outline.faces.size() == outline.edges.size() + 2;
}

// Whether all faces face the same way, and no corner lies to the right of a border edge, as seen
// from the front.
bool IsConvexPolygon(const MeshOutline& outline) {
  const Vec3d& up = outline.faces[0].cross;
  for (const OutlineFace& face : outline.faces) {
    if (!((face.cross ^ up) > 0)) return false;
  }
  // The tolerance for corners that are rounded in files, relative to the squared edge length.
  constexpr double kRounding = 1e-7;
  for (const OutlineEdge& edge : outline.edges) {
    if (edge.right != kNoFace) continue;
    const Vec3d& from = outline.corners[edge.from];
    const Vec3d along = outline.corners[edge.to] - from;
    for (const Vec3d& corner : outline.corners) {
      const double across = up ^ (along % (corner - from));
      if (across < -kRounding * up.length() * along.length2()) return false;
    }
  }
  return outline.corners.size() + outline.faces.size() == outline.edges.size() + 1;
}

}  // namespace

MeshOutline MakeMeshOutline(std::span<const Vec3d> positions, std::span<const uint32_t> triangles,
                            const Vec3d& origin, bool is_flat) {
  MeshOutline outline;
  // All vertices at the same position are one corner.
  std::map<std::tuple<double, double, double>, uint32_t> numbers;
  const auto corner_at = [&](const Vec3d& p) {
    const auto next = static_cast<uint32_t>(outline.corners.size());
    const auto [entry, is_new] = numbers.try_emplace(std::tuple(p.x, p.y, p.z), next);
    if (is_new) outline.corners.push_back(p);
    return entry->second;
  };
  std::vector<Corners> faces;
  faces.reserve(triangles.size() / 3);
  outline.faces.reserve(triangles.size() / 3);
  for (size_t i = 0; i + 2 < triangles.size(); i += 3) {
    const Vec3d &a = positions[triangles[i]], &b = positions[triangles[i + 1]],
                &c = positions[triangles[i + 2]];
    const Vec3d cross = (b - a) % (c - a);
    if (!(cross.length() > 0)) continue;
    faces.push_back({corner_at(a), corner_at(b), corner_at(c)});
    outline.faces.push_back({faces.back()[0], cross});
  }
  const bool known = FindEdges(faces, &outline.edges) && CountPieces(outline) == 1 &&
                     outline.corners.size() <= kMaxOutlineCorners &&
                     (is_flat ? IsConvexPolygon(outline) : IsSolid(outline));
  if (!known) return {};
  for (Vec3d& corner : outline.corners) corner -= origin;
  return outline;
}

}  // namespace nacre
