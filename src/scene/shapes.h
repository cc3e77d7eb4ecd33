// SPDX-License-Identifier: Apache-2.0
// scene/shapes.h: spheres and meshes.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/vec.h"
#include "scene/handle.h"

namespace nacre {

struct Sphere {
  Vec3d center{0, 0, 0};
  double radius = 1;  // > 0
  MaterialId material;
};

// What is interpolated across a triangle.
enum class Interpolation : uint8_t {
  kPhong,    // the vertices' normals, renormalised at each point (Phong 1975)
  kGouraud,  // the light that the vertices reflect (Gouraud 1971), diffuse and specular apart
  kFlat,     // nothing: all of the triangle reflects what its centroid does with the face normal
  kFaceted,  // only the position: every point has the face normal
};

// The direction of x of a normal map. y is cross(normal, direction) times the sign.
struct Tangent {
  Vec3d direction{1, 0, 0};  // unit, across the normal
  double sign = 1;           // -1 where the texture is mirrored, else 1
};

struct Mesh {
  std::string name{};
  std::vector<Vec3d> positions{};   // world space
  std::vector<Vec3d> normals{};     // unit, one per position; empty: face normals
  std::vector<Vec2d> uvs{};         // one per position, or empty; (0, 0) is an image's bottom left
  std::vector<Vec2d> second_uvs{};  // one per position, or empty; for Texture::second_uvs
  std::vector<Vec3f> colors{};      // linear, each in [0, 1], one per position, or empty
  // As the file has them, one per position, with a normal for each. If empty, normal maps on `uvs`
  // use MakeTangents (scene/tangents.h).
  std::vector<Tangent> tangents{};
  std::vector<float> opacities{};     // each in [0, 1], one per position, or empty: 1
  std::vector<uint32_t> triangles{};  // three indices each, counter-clockwise from outside
  MaterialId material{};
  Interpolation interpolation = Interpolation::kPhong;
  // Whether shadow rays from hits with smooth normals start on the curved surface that the normals
  // suggest, not in the triangle (Hanika 2021), which avoids jagged shadows along the terminator of
  // coarse meshes.
  bool smooth_terminator = true;
};

// Whether hits have normals that are interpolated from the vertices.
inline bool HasSmoothNormals(const Mesh& mesh) {
  return !mesh.normals.empty() && (mesh.interpolation == Interpolation::kPhong ||
                                   mesh.interpolation == Interpolation::kGouraud);
}

}  // namespace nacre
