// SPDX-License-Identifier: Apache-2.0
#include "render/mesh_radiance.h"

#include <algorithm>

#include "scene/mesh.h"

namespace nacre {
namespace {

// 1 where the camera sees the triangle's front, -1 where it sees its back: the same for all of it.
double SideSeen(const CameraFrame& camera, const Corners& corners) {
  const Vec3d normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  const bool parallel = camera.projection == Projection::kOrthographic;
  return normal.dot(parallel ? camera.forward : corners[0]) > 0 ? -1 : 1;
}

// One of the arrays between the corners.
class Between {
 public:
  Between(const TriangleRef& triangle, const MeshRadiance& radiance,
          const std::array<uint32_t, 3>& sides, const Vec3d& weights)
      : triangle_(triangle), radiance_(radiance), sides_(sides), weights_(weights) {}

  template <class Array>
  Vec3d Mean(const Array& array) const {
    Vec3d mean(0);
    for (int c = 0; c < 3; ++c) {
      const auto corner = static_cast<size_t>(c);
      const SideRadiance& side = radiance_.sides[sides_[corner]];
      mean += Vec3d(array(side)[triangle_.Vertex(corner)]) * weights_[c];
    }
    return mean;
  }

 private:
  const TriangleRef& triangle_;
  const MeshRadiance& radiance_;
  const std::array<uint32_t, 3>& sides_;
  const Vec3d& weights_;
};

void Put(const Vec3d& value, size_t i, Soa3<float>* to) {
  to->x[i] = static_cast<float>(value.x);
  to->y[i] = static_cast<float>(value.y);
  to->z[i] = static_cast<float>(value.z);
}

// Calls put(array of a SideRadiance, where it goes) for everything that hits reflect.
template <class PutArray>
void ForEachArray(BatchRadiance* radiance, const PutArray& put) {
  put(
      [](const SideRadiance& side) -> const auto& { return side.diffuse; },
      &radiance->total.diffuse);
  put(
      [](const SideRadiance& side) -> const auto& { return side.specular; },
      &radiance->total.specular);
  for (size_t l = 0; l < radiance->per_light.size(); ++l) {
    put(
        [l](const SideRadiance& side) -> const auto& { return side.lights[l]; },
        &radiance->per_light[l]);
  }
}

void InterpolateHit(const DirectBatch& batch, const TriangleRef& triangle,
                    const MeshRadiance& radiance, size_t hit) {
  if (triangle.mesh->interpolation == Interpolation::kFlat) {
    ForEachArray(&batch.radiance, [&](const auto& array, Soa3<float>* to) {
      Put(Vec3d(array(radiance.sides[0])[triangle.triangle]), hit, to);
    });
    return;
  }
  const Soa3<double>& p = batch.hits().position;
  const Corners corners = CornersOf(*batch.plan.primitives.scene, triangle);
  const Vec3d normal = SeenNormal(batch.plan.camera, triangle, corners);
  const std::array<uint32_t, 3> sides = {SideOf(triangle, 0, normal), SideOf(triangle, 1, normal),
                                         SideOf(triangle, 2, normal)};
  const Vec3d weights = WeightsAt(corners, Vec3d(p.x[hit], p.y[hit], p.z[hit]));
  const Between between(triangle, radiance, sides, weights);
  ForEachArray(&batch.radiance,
               [&](const auto& array, Soa3<float>* to) { Put(between.Mean(array), hit, to); });
}

}  // namespace

uint32_t SideOf(const TriangleRef& triangle, size_t corner, const Vec3d& seen_normal) {
  return triangle.mesh->normals[triangle.Vertex(corner)].dot(seen_normal) < 0 ? 1 : 0;
}

Vec3d SeenNormal(const CameraFrame& camera, const TriangleRef& triangle, const Corners& corners) {
  return FaceNormal(*triangle.mesh, triangle.triangle) * SideSeen(camera, corners);
}

void InterpolateRadiance(const DirectBatch& batch) {
  for (const MaterialRun& run : batch.surfaces.runs) {
    if (!run.interpolated) continue;
    for (size_t hit = run.begin; hit < run.end; ++hit) {
      const TriangleRef triangle = TriangleOf(batch.plan.primitives, batch.hits().primitive[hit]);
      const std::vector<MeshRadiance>& sets = batch.plan.mesh_radiance[triangle.number];
      const auto found = std::find_if(sets.begin(), sets.end(), [&](const MeshRadiance& set) {
        return set.material == run.material;
      });
      if (found != sets.end()) {
        InterpolateHit(batch, triangle, *found, hit);
      } else {  // the black back of what emits in front only
        ForEachArray(&batch.radiance,
                     [&](const auto&, Soa3<float>* to) { Put(Vec3d(0), hit, to); });
      }
    }
  }
}

}  // namespace nacre
