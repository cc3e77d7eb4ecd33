// SPDX-License-Identifier: Apache-2.0
// visibility/cut_out.h: meshes with holes, which are cut out by an opacity (Material::opacity_map).
// Rays of every kind ignore hits in holes.
//
// The look-up is scalar and in double. It depends on the weights of the triangle test, which have
// the same bits on all targets, and so do the holes.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "scene/texture_mapping.h"

namespace nacre {

struct Scene;
struct Mesh;

struct CutOut {
  uint32_t begin = 0, end = 0;  // the mesh's triangles, numbered as in TraceGeometry
  uint32_t first_vertex = 0;    // the mesh's first vertex in TraceGeometry::positions
  double opacity = 1;
  double cutoff = 0.5;
  std::vector<float> opacities;  // per vertex of the mesh; empty: 1
  // The opacity map; null: 1 everywhere.
  std::shared_ptr<const MipChain> image;
  Texture texture;
  UvTransform transform;
  std::vector<Vec2d> uvs;  // per vertex of the mesh; empty unless the mapping is kUv
  Vec3d center{0, 0, 0};   // the origin of other mappings, relative to the camera
};

// Returns nullopt if no opacity can be below the cutoff. The caller sets begin, end and
// first_vertex, and MoveCutOut sets the centre.
std::optional<CutOut> MakeCutOut(const Scene& scene, const Mesh& mesh);

void MoveCutOut(const Vec3d& camera_position, CutOut* cut_out);

// Whether the surface exists at the point with these weights in the triangle of these corners,
// which index TraceGeometry::positions.
bool IsSolidAt(const CutOut& cut_out, const std::vector<Vec3d>& positions,
               const std::array<uint32_t, 3>& corners, const std::array<double, 3>& weights);

// The CutOut of the triangle's mesh, or null if the mesh has no holes.
const CutOut* FindCutOut(const std::vector<CutOut>& cut_outs, uint32_t triangle);

}  // namespace nacre
