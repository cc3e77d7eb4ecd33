// SPDX-License-Identifier: Apache-2.0
#include "render/mesh_radiance.h"

#include <algorithm>

#include "scene/mesh.h"

namespace nacre {
namespace {

// 1 if the camera sees the triangle's front, -1 if it sees its back.
double VisibleSide(const CameraFrame& camera, const Corners& corners) {
  const Vec3d normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  const bool parallel = camera.projection == Projection::kOrthographic;
  return normal.dot(parallel ? camera.forward : corners[0]) > 0 ? -1 : 1;
}

// Calls set(value, to) for each array `to` of BatchRadiance, where value(side, i) is what entry i
// of a SideRadiance contributes to it.
template <class Set>
void ForEachArray(BatchRadiance* radiance, const Set& set) {
  const auto entry_of = [](size_t array) {
    return [array](const SideRadiance& side, size_t i) { return Vec3d(side[array][i]); };
  };
  const auto diffuse = entry_of(kDiffuseArray), specular = entry_of(kSpecularArray);
  ReflectedRadiance& total = radiance->total;
  set(diffuse, &total.diffuse);
  set(specular, &total.specular);
  set([&](const SideRadiance& side, size_t i) { return diffuse(side, i) + specular(side, i); },
      &total.sum);
  for (size_t l = 0; l < radiance->per_light.size(); ++l) {
    set(entry_of(kFirstLightArray + l), &radiance->per_light[l]);
  }
}

void InterpolateHit(const TracedShapes& shapes, const TriangleRef& triangle,
                    const MeshRadiance& radiance, const Vec3d& position, size_t hit,
                    BatchRadiance* result) {
  if (triangle.mesh->interpolation == Interpolation::kFlat) {
    ForEachArray(result, [&](const auto& value, Soa3<float>* to) {
      SetVector(value(radiance.sides[0], triangle.triangle), hit, to);
    });
    return;
  }
  const Corners corners = CornersOf(*shapes.primitives.scene, triangle);
  const Vec3d normal = VisibleNormal(shapes.camera, triangle, corners);
  const std::array<uint32_t, 3> sides = {SideOf(triangle, 0, normal), SideOf(triangle, 1, normal),
                                         SideOf(triangle, 2, normal)};
  const Vec3d weights = BarycentricsAt(corners, position);
  ForEachArray(result, [&](const auto& value, Soa3<float>* to) {
    Vec3d mean(0);
    for (size_t c = 0; c < 3; ++c) {
      const SideRadiance& side = radiance.sides[sides[c]];
      mean += value(side, triangle.Vertex(c)) * weights[static_cast<int>(c)];
    }
    SetVector(mean, hit, to);
  });
}

}  // namespace

uint32_t SideOf(const TriangleRef& triangle, size_t corner, const Vec3d& visible_normal) {
  return triangle.mesh->normals[triangle.Vertex(corner)].dot(visible_normal) < 0 ? 1 : 0;
}

Vec3d VisibleNormal(const CameraFrame& camera, const TriangleRef& triangle,
                    const Corners& corners) {
  return FaceNormal(*triangle.mesh, triangle.triangle) * VisibleSide(camera, corners);
}

void InterpolateRadiance(const TracedShapes& shapes, const RadianceOfMeshes& meshes,
                         const Surfaces& surfaces, BatchRadiance* radiance) {
  for (const MaterialRun& run : surfaces.runs) {
    if (!run.interpolated) continue;
    for (size_t hit = run.begin; hit < run.end; ++hit) {
      const TriangleRef triangle = TriangleOf(shapes.primitives, surfaces.hits.primitive[hit]);
      const std::vector<MeshRadiance>& sets = meshes[triangle.number];
      const auto found = std::ranges::find(sets, run.material, &MeshRadiance::material);
      if (found != sets.end()) {
        InterpolateHit(shapes, triangle, *found, VectorAt(surfaces.hits.position, hit), hit,
                       radiance);
      } else {  // SurfacePlan::black: the back of a material that emits in front only
        ForEachArray(radiance, [&](const auto&, Soa3<float>* to) { SetVector(Vec3d(0), hit, to); });
      }
    }
  }
}

}  // namespace nacre
