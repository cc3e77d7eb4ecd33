// SPDX-License-Identifier: Apache-2.0
#include "render/mesh_points.h"

#include <algorithm>

#include "render/tile.h"

namespace nacre {
namespace {

bool Lifts(const Mesh& mesh) {
  return mesh.smooth_terminator && HasSmoothNormals(mesh) &&
         mesh.interpolation == Interpolation::kPhong;
}

}  // namespace

TriangleRef TriangleOf(const RenderPlan& plan, uint32_t primitive) {
  const uint32_t triangle = primitive - static_cast<uint32_t>(plan.scene->spheres.size());
  const auto& first = plan.mesh_first_triangle;
  const auto after = std::upper_bound(first.begin(), first.end(), triangle);
  const auto number = static_cast<size_t>(after - first.begin()) - 1;
  return {&plan.scene->meshes[number], number, triangle - first[number]};
}

Corners CornersOf(const RenderPlan& plan, const TriangleRef& triangle) {
  const Vec3d& eye = plan.scene->camera.position;
  const std::vector<Vec3d>& positions = triangle.mesh->positions;
  return {positions[triangle.Vertex(0)] - eye, positions[triangle.Vertex(1)] - eye,
          positions[triangle.Vertex(2)] - eye};
}

Vec3d WeightsAt(const Corners& corners, const Vec3d& point) {
  const Vec3d ab = corners[1] - corners[0], ac = corners[2] - corners[0];
  const Vec3d ap = point - corners[0];
  const Vec3d normal = ab.cross(ac);
  const double square = normal.dot(normal);
  if (!(square > 0)) return {1, 0, 0};
  const double b = std::clamp(ap.cross(ac).dot(normal) / square, 0.0, 1.0);
  const double c = std::clamp(ab.cross(ap).dot(normal) / square, 0.0, 1.0 - b);
  return {1 - b - c, b, c};
}

double SideSeen(const RenderPlan& plan, const Corners& corners) {
  const Vec3d normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  const bool parallel = plan.camera.projection == Projection::kOrthographic;
  return normal.dot(parallel ? plan.camera.forward : corners[0]) > 0 ? -1 : 1;
}

Vec3d LiftedOrigin(const Corners& corners, const Corners& normals, const Vec3d& weights,
                   const Vec3d& point) {
  Vec3d lifted = point;
  for (int i = 0; i < 3; ++i) {
    const auto corner = static_cast<size_t>(i);
    const double above = (point - corners[corner]).dot(normals[corner]);
    lifted -= normals[corner] * (weights[i] * std::min(above, 0.0));
  }
  return lifted;
}

bool LiftsShadowOrigins(const Scene& scene) {
  return std::any_of(scene.meshes.begin(), scene.meshes.end(), Lifts);
}

void LiftShadowOrigins(const RenderPlan& plan, TileScratch* scratch) {
  TileScratch& s = *scratch;
  const auto spheres = static_cast<uint32_t>(plan.scene->spheres.size());
  const Soa3<double>& position = s.hits.position;
  const Soa3<float>& normal = s.surface.normal;
  for (size_t i = 0; i < s.hits.count; ++i) {
    Vec3d origin(position.x[i], position.y[i], position.z[i]);
    if (s.hits.primitive[i] >= spheres) {
      const TriangleRef triangle = TriangleOf(plan, s.hits.primitive[i]);
      if (Lifts(*triangle.mesh)) {
        const Corners corners = CornersOf(plan, triangle);
        Corners normals;
        Vec3d sum(0, 0, 0);
        for (size_t c = 0; c < 3; ++c) {
          normals[c] = triangle.mesh->normals[triangle.Vertex(c)];
          sum += normals[c];
        }
        // The hit's normal is on the side that is seen; those of the vertices may not be.
        if (sum.dot(Vec3d(normal.x[i], normal.y[i], normal.z[i])) < 0) {
          for (Vec3d& n : normals) n = -n;
        }
        origin = LiftedOrigin(corners, normals, WeightsAt(corners, origin), origin);
      }
    }
    s.shadow_origin.x[i] = origin.x;
    s.shadow_origin.y[i] = origin.y;
    s.shadow_origin.z[i] = origin.z;
  }
}

}  // namespace nacre
