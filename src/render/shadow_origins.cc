// SPDX-License-Identifier: Apache-2.0
#include "render/shadow_origins.h"

#include <algorithm>

namespace nacre {
namespace {

bool OffsetsOrigins(const Mesh& mesh) {
  return mesh.smooth_terminator && HasSmoothNormals(mesh) &&
         mesh.interpolation == Interpolation::kPhong;
}

}  // namespace

Corners CornersOf(const Scene& scene, const TriangleRef& triangle) {
  const Vec3d& eye = scene.camera.position;
  const std::vector<Vec3d>& positions = triangle.mesh->positions;
  return {positions[triangle.Vertex(0)] - eye, positions[triangle.Vertex(1)] - eye,
          positions[triangle.Vertex(2)] - eye};
}

Vec3d BarycentricsAt(const Corners& corners, const Vec3d& point) {
  const Vec3d ab = corners[1] - corners[0], ac = corners[2] - corners[0];
  const Vec3d ap = point - corners[0];
  const Vec3d normal = ab.cross(ac);
  const double square = normal.dot(normal);
  if (!(square > 0)) return {1, 0, 0};
  const double b = std::clamp(ap.cross(ac).dot(normal) / square, 0.0, 1.0);
  const double c = std::clamp(ab.cross(ap).dot(normal) / square, 0.0, 1.0 - b);
  return {1 - b - c, b, c};
}

Vec3d OffsetOrigin(const Corners& corners, const Corners& normals, const Vec3d& weights,
                   const Vec3d& point) {
  Vec3d lifted = point;
  for (int i = 0; i < 3; ++i) {
    const auto corner = static_cast<size_t>(i);
    const double above = (point - corners[corner]).dot(normals[corner]);
    lifted -= normals[corner] * (weights[i] * std::min(above, 0.0));
  }
  return lifted;
}

bool PlanShadowOrigins(const Scene& scene, const TracedShapes& shapes, const ShadowPlan& shadows,
                       Explanation* why) {
  if (scene.meshes.empty() || shapes.intersector == nullptr) return false;
  const auto any = [](const std::vector<LightShadows>& lights) {
    return std::ranges::any_of(lights, &LightShadows::rays);
  };
  const bool rays = any(shadows.punctual) || any(shadows.sampled);
  const bool offset = rays && std::any_of(scene.meshes.begin(), scene.meshes.end(), OffsetsOrigins);
  why->items.push_back({"smooth terminator", offset,
                        offset ? "shadow rays of smooth normals start on the curved surface"
                        : rays ? "no mesh has smooth normals and asks for it"
                               : "there are no shadow rays"});
  return offset;
}

void OffsetShadowOrigins(const DirectBatch& batch) {
  const PrimitiveNumbers& primitives = batch.plan.shapes.primitives;
  const HitBatch& hits = batch.hits();
  const Soa3<float>& normal = batch.surface().normal;
  for (size_t i = 0; i < batch.lit(); ++i) {
    Vec3d origin = VectorAt(hits.position, i);
    if (!IsSphere(primitives, hits.primitive[i])) {
      const TriangleRef triangle = TriangleOf(primitives, hits.primitive[i]);
      if (OffsetsOrigins(*triangle.mesh)) {
        const Corners corners = CornersOf(*primitives.scene, triangle);
        Corners normals;
        Vec3d sum(0, 0, 0);
        for (size_t c = 0; c < 3; ++c) {
          normals[c] = triangle.mesh->normals[triangle.Vertex(c)];
          sum += normals[c];
        }
        // The hit's normal is on the visible side; those of the vertices may be on the other.
        if (sum.dot(VectorAt(normal, i)) < 0) {
          for (Vec3d& n : normals) n = -n;
        }
        origin = OffsetOrigin(corners, normals, BarycentricsAt(corners, origin), origin);
      }
    }
    SetVector(origin, i, &batch.room.shadow_origin);
  }
}

}  // namespace nacre
