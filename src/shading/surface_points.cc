// SPDX-License-Identifier: Apache-2.0
// shading/surface_points.cc: where hits lie on their shapes: the input of mappings, and data of the
// triangles that were hit on meshes.
#include <algorithm>
#include <cmath>

#include "scene/mesh.h"
#include "shading/texture_kernels.h"

namespace nacre {
namespace {

// A triangle, relative to its first corner.
struct Corners {
  const Mesh* mesh;
  size_t mesh_number;  // index in the scene
  size_t first;        // index of the first corner in Mesh::triangles
  uint32_t index[3];
  Vec3d a, e1, e2;  // the first corner, in world space, and the edges from it
};

Corners CornersOf(const TextureScene& scene, uint32_t primitive) {
  const TriangleRef triangle = TriangleOf(scene.primitives, primitive);
  Corners corners;
  corners.mesh = triangle.mesh;
  corners.mesh_number = triangle.number;
  corners.first = 3 * size_t{triangle.triangle};
  for (size_t k = 0; k < 3; ++k) corners.index[k] = triangle.Vertex(k);
  corners.a = corners.mesh->positions[corners.index[0]];
  corners.e1 = corners.mesh->positions[corners.index[1]] - corners.a;
  corners.e2 = corners.mesh->positions[corners.index[2]] - corners.a;
  return corners;
}

// The gradients of the barycentric coordinates: the dual basis of the edges, in their plane.
struct Gradients {
  Vec3d of_b1, of_b2;
};

Gradients GradientsOf(const Corners& corners) {
  const Vec3d n = corners.e1.cross(corners.e2);
  const double area2 = n.dot(n);
  return {corners.e2.cross(n) / area2, n.cross(corners.e1) / area2};
}

}  // namespace

void FindPoints(const TexturedRun& run) {
  const HitBatch& hits = run.hits;
  HitParameters& t = run.textures;
  const Scene& scene = *run.scene.scene;
  const auto sphere_count = static_cast<uint32_t>(scene.spheres.size());
  t.any_mesh = false;
  uint32_t last = kNoPrimitive;  // the last sphere: neighbouring hits are mostly on the same one
  Vec3d center(0, 0, 0);
  double inverse_radius = 1;
  for (size_t i = run.begin; i < run.end; ++i) {
    const uint32_t primitive = hits.primitive[i];
    const Vec3d normal = VectorAt(hits.normal, i);
    if (run.material.by_hit.normal) SetVector(normal, i, &t.interpolated_normal);
    if (primitive < sphere_count) {
      if (primitive != last) {
        last = primitive;
        center = scene.spheres[primitive].center - scene.camera.position;
        inverse_radius = 1 / scene.spheres[primitive].radius;
      }
      // The normal is on the ray's side; from inside it points to the centre.
      const double side = (VectorAt(hits.position, i) - center).dot(normal) < 0 ? -1 : 1;
      t.side[i] = side;
      SetVector(normal * side, i, &t.point);
      t.inverse_size[i] = inverse_radius;
      SetVector(normal, i, &t.geometric);
    } else {
      const Corners corners = CornersOf(run.scene, primitive);
      const Vec3d face = corners.e1.cross(corners.e2).normalized();
      t.side[i] = face.dot(VectorAt(hits.to_view, i)) < 0 ? -1 : 1;
      SetVector(face * t.side[i], i, &t.geometric);
      t.any_mesh = true;
    }
  }
}

void FindMeshCoordinates(const TexturedRun& run, const PreparedTexture& texture) {
  const HitBatch& hits = run.hits;
  HitParameters& t = run.textures;
  const Scene& scene = *run.scene.scene;
  const auto sphere_count = static_cast<uint32_t>(scene.spheres.size());
  for (size_t i = run.begin; i < run.end; ++i) {
    if (hits.primitive[i] < sphere_count) continue;
    const Corners corners = CornersOf(run.scene, hits.primitive[i]);
    const std::vector<Vec2d>& uvs = UvsOf(*corners.mesh, texture.second_uvs);
    if (uvs.empty()) continue;  // ShapeCoordinates of PlaceMeshPoints
    const Vec2d uv = uvs[corners.index[0]];
    const Vec2d d1 = uvs[corners.index[1]] - uv, d2 = uvs[corners.index[2]] - uv;
    const auto [g1, g2] = GradientsOf(corners);
    const Vec3d from_a = VectorAt(hits.position, i) - (corners.a - scene.camera.position);
    const double b1 = g1.dot(from_a), b2 = g2.dot(from_a);
    t.u[i] = uv.x + b1 * d1.x + b2 * d2.x;
    t.v[i] = uv.y + b1 * d1.y + b2 * d2.y;
    SetVector(g1 * d1.x + g2 * d2.x, i, &t.gradient_u);
    SetVector(g1 * d1.y + g2 * d2.y, i, &t.gradient_v);
  }
}

bool FindTangents(const TexturedRun& run, const PreparedTexture& texture) {
  if (run.scene.mesh_tangents.empty()) return false;
  const auto number = static_cast<uint32_t>(&texture - run.scene.textures.data());
  const HitBatch& hits = run.hits;
  HitParameters& t = run.textures;
  const Scene& scene = *run.scene.scene;
  const auto sphere_count = static_cast<uint32_t>(scene.spheres.size());
  bool any = false;
  for (size_t i = run.begin; i < run.end; ++i) {
    t.normal_length[i] = 0;
    if (hits.primitive[i] < sphere_count) continue;
    const Corners corners = CornersOf(run.scene, hits.primitive[i]);
    const std::vector<MapTangents>& of_mesh = run.scene.mesh_tangents[corners.mesh_number];
    const auto own = std::find_if(of_mesh.begin(), of_mesh.end(),
                                  [&](const MapTangents& t) { return t.texture == number; });
    if (own == of_mesh.end()) continue;
    const CornerTangents& made = *run.scene.tangents[own->tangents];
    const auto [g1, g2] = GradientsOf(corners);
    const Vec3d from_a = VectorAt(hits.position, i) - (corners.a - scene.camera.position);
    const double b1 = g1.dot(from_a), b2 = g2.dot(from_a);
    const double weights[3] = {1 - b1 - b2, b1, b2};
    const bool smooth = HasSmoothNormals(*corners.mesh);
    Vec3d normal = smooth ? Vec3d(0) : corners.e1.cross(corners.e2).normalized();
    Vec3d tangent(0);
    double sign = 0;  // the signs are equal at all corners, unless a file says otherwise
    for (size_t k = 0; k < 3; ++k) {
      const Tangent& corner = made.tangents[made.corners[corners.first + k]];
      tangent += corner.direction * weights[k];
      sign += corner.sign * weights[k];
      if (smooth) normal += corners.mesh->normals[corners.index[k]] * weights[k];
    }
    // Seen from behind, the frame is that of the front, mirrored at the point.
    const double side = normal.dot(VectorAt(hits.normal, i)) < 0 ? -1 : 1;
    SetVector(tangent * side, i, &t.tangent);
    SetVector(normal.cross(tangent) * (sign < 0 ? -side : side), i, &t.bitangent);
    t.normal_length[i] = normal.length();
    any = true;
  }
  return any;
}

void FindVertexColors(const TexturedRun& run) {
  const HitBatch& hits = run.hits;
  Soa3<float>& to = run.textures.texels;
  const Scene& scene = *run.scene.scene;
  const auto sphere_count = static_cast<uint32_t>(scene.spheres.size());
  for (size_t i = run.begin; i < run.end; ++i) {
    Vec3d color(1);
    if (hits.primitive[i] >= sphere_count) {
      const Corners corners = CornersOf(run.scene, hits.primitive[i]);
      const std::vector<Vec3f>& colors = corners.mesh->colors;
      if (!colors.empty()) {
        const auto [g1, g2] = GradientsOf(corners);
        const Vec3d from_a = VectorAt(hits.position, i) - (corners.a - scene.camera.position);
        const Vec3d first(colors[corners.index[0]]);
        color = first + (Vec3d(colors[corners.index[1]]) - first) * g1.dot(from_a) +
                (Vec3d(colors[corners.index[2]]) - first) * g2.dot(from_a);
      }
    }
    SetVector(color, i, &to);
  }
}

}  // namespace nacre
