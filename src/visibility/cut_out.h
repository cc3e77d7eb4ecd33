// SPDX-License-Identifier: Apache-2.0
// visibility/cut_out.h: meshes with holes: which points of their triangles are there
// (Material::opacity_map). A hit in a hole is none, for rays of every kind.
//
// The look-up is scalar and in double, from the weights of the triangle test, which are the same on
// all targets: so are the holes.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "scene/scene.h"
#include "scene/texture_mapping.h"

namespace nacre {

struct CutOut {
  uint32_t begin = 0, end = 0;  // the triangles of the mesh, as TraceGeometry numbers them
  uint32_t first_vertex = 0;    // the mesh's, likewise
  double opacity = 1;
  double cutoff = 0.5;
  std::vector<float> opacities;  // by vertex of the mesh; or empty: 1
  // The map; null: 1.
  std::shared_ptr<const MipChain> image;
  Texture texture;
  UvTransform transform;
  std::vector<Vec2d> uvs;  // by vertex of the mesh; of mappings other than kUv empty
  Vec3d center{0, 0, 0};   // of such mappings, relative to the camera
};

// Null if no opacity can be below the cutoff. The triangles' numbers are not filled in.
std::optional<CutOut> MakeCutOut(const Scene& scene, const Mesh& mesh,
                                 const Vec3d& camera_position);

// Whether the surface is there, at the point of these weights in the triangle of these corners,
// which `positions` of TraceGeometry has.
bool IsThere(const CutOut& cut_out, const std::vector<Vec3d>& positions,
             const std::array<uint32_t, 3>& corners, const std::array<double, 3>& weights);

// The holes of the triangle's mesh; null if it has none.
const CutOut* FindCutOut(const std::vector<CutOut>& cut_outs, uint32_t triangle);

}  // namespace nacre
