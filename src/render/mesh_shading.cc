// SPDX-License-Identifier: Apache-2.0
#include "render/mesh_shading.h"

#include <algorithm>
#include <memory>
#include <mutex>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "base/parallel.h"
#include "hit/shading_normal.h"
#include "render/direct.h"
#include "render/samples.h"
#include "sampling/hash.h"

namespace nacre {
namespace {

// A point at which a mesh is shaded.
struct Point {
  Vec3d position;  // relative to the camera
  Vec3d normal;
  uint32_t primitive;  // that the point lies on
  uint32_t index;      // of the vertex or triangle in the mesh
  uint32_t side;       // index into MeshRadiance::sides
};

// For both sides, by vertex: the first triangle on which the camera sees this side of the vertex,
// or kNoTriangle.
constexpr uint32_t kNoTriangle = 0xffffffffu;
using SideTriangles = std::array<std::vector<uint32_t>, 2>;

std::vector<Point> FlatPoints(const Scene& scene, const CameraFrame& camera, size_t number,
                              uint32_t first) {
  const Mesh& mesh = scene.meshes[number];
  std::vector<Point> points;
  points.reserve(mesh.triangles.size() / 3);
  for (uint32_t i = 0; i < mesh.triangles.size() / 3; ++i) {
    const TriangleRef triangle{&mesh, number, i};
    const Corners corners = CornersOf(scene, triangle);
    const Vec3d normal = VisibleNormal(camera, triangle, corners);
    if (normal == Vec3d(0, 0, 0)) continue;  // degenerate: no ray hits it
    points.push_back({(corners[0] + corners[1] + corners[2]) / 3, normal, first + i, i, 0});
  }
  return points;
}

std::vector<Point> VertexPoints(const Scene& scene, const CameraFrame& camera, size_t number,
                                uint32_t first) {
  const Mesh& mesh = scene.meshes[number];
  SideTriangles seen;
  for (std::vector<uint32_t>& side : seen) side.assign(mesh.positions.size(), kNoTriangle);
  for (uint32_t i = 0; i < mesh.triangles.size() / 3; ++i) {
    const TriangleRef triangle{&mesh, number, i};
    const Vec3d normal = VisibleNormal(camera, triangle, CornersOf(scene, triangle));
    if (normal == Vec3d(0, 0, 0)) continue;
    for (size_t c = 0; c < 3; ++c) {
      uint32_t& entry = seen[SideOf(triangle, c, normal)][triangle.Vertex(c)];
      entry = std::min(entry, i);
    }
  }
  std::vector<Point> points;
  points.reserve(mesh.positions.size());
  for (uint32_t side = 0; side < 2; ++side) {
    for (uint32_t i = 0; i < mesh.positions.size(); ++i) {
      if (seen[side][i] == kNoTriangle) continue;
      points.push_back({mesh.positions[i] - scene.camera.position,
                        mesh.normals[i] * (side == 0 ? 1.0 : -1.0), first + seen[side][i], i,
                        side});
    }
  }
  return points;
}

// Makes hits of up to kBatchCapacity points, as if camera rays hit them.
void MakeHits(const CameraFrame& camera, const Point* points, size_t count, Surfaces* to) {
  const bool parallel = camera.projection == Projection::kOrthographic;
  HitBatch& hits = to->hits;
  hits.count = count;
  hits.one_primitive = false;
  for (size_t i = 0; i < RoundUp(count, kBatchPadding); ++i) {
    const Point& point = points[std::min(i, count - 1)];
    Vec3d to_view = parallel ? -camera.forward : -point.position.normalized();
    if (to_view == Vec3d(0, 0, 0)) to_view = point.normal;  // the camera is at the vertex
    SetVector(point.position, i, &hits.position);
    SetVector(point.normal, i, &hits.normal);
    SetVector(GrazingView(point.normal, to_view), i, &hits.to_view);
    hits.primitive[i] = point.primitive;
    hits.ray[i] = static_cast<uint32_t>(i);
  }
  PrepareSurface(hits, &to->surface);
}

size_t ArraysPerSide(const LightsPlan& lights) {
  return kFirstLightArray + lights.light_layer_count;
}

// How often each point is shaded: as often as a pixel if there are sampled lights, else once.
int SamplesOf(const LightsPlan& plan) {
  return plan.sampled.empty() ? 1 : static_cast<int>(plan.pairs.samples);
}

// The plans that the shading of points reads.
struct MeshShading {
  const SurfacePlan& surfaces;
  const DirectPlan& direct;
};

// Buffers for batches of points.
struct PointRoom {
  Surfaces surfaces;
  SampleNumbers numbers{kBatchCapacity};
  DirectRoom direct;
  BatchRadiance radiance;
};

void ShadePoints(const MeshShading& plans, const Point* points, size_t count, MeshRadiance* to,
                 PointRoom* room, RenderStats* stats) {
  StageClock clock(nullptr);
  Surfaces& surfaces = room->surfaces;
  const BatchRadiance& radiance = room->radiance;
  MakeHits(plans.direct.shapes.camera, points, count, &surfaces);
  surfaces.footprints = {&plans.surfaces.camera};
  surfaces.runs = {{to->material, &plans.surfaces.materials[to->material.index], 0, count, false}};
  PrepareSurfaces(plans.surfaces, &surfaces);
  // Over the samples, in double, by array of a SideRadiance.
  std::vector<std::vector<Vec3d>> sums(ArraysPerSide(plans.direct.lights),
                                       std::vector<Vec3d>(count, Vec3d(0)));
  const int samples = SamplesOf(plans.direct.lights);
  const auto seed_of = [&](size_t i) { return HashCombine(points[i].primitive, points[i].index); };
  for (int k = 0; k < samples; ++k) {
    NumberPixelByPixel(count, k, 1, seed_of, &room->numbers);
    ShadeDirect({plans.direct, surfaces, room->direct, room->radiance, clock, *stats},
                &room->numbers);
    for (size_t a = 0; a < sums.size(); ++a) {
      const Soa3<float>& from = a == kDiffuseArray    ? radiance.total.diffuse
                                : a == kSpecularArray ? radiance.total.specular
                                                      : radiance.per_light[a - kFirstLightArray];
      for (size_t i = 0; i < count; ++i) sums[a][i] += VectorAt(from, i);
    }
  }
  for (size_t a = 0; a < sums.size(); ++a) {
    for (size_t i = 0; i < count; ++i) {
      to->sides[points[i].side][a][points[i].index] = Vec3f(sums[a][i] / samples);
    }
  }
}

MeshRadiance ShadeMesh(const MeshShading& plans, const RenderSettings& settings,
                       const std::vector<Point>& points, size_t size, MaterialId material,
                       RenderStats* stats) {
  MeshRadiance radiance;
  radiance.material = material;
  for (uint32_t side = 0; side < 2; ++side) {
    if (std::ranges::find(points, side, &Point::side) == points.end()) continue;  // not seen
    radiance.sides[side].assign(ArraysPerSide(plans.direct.lights), std::vector<Vec3f>(size));
  }
  // A task takes several batches, because its buffers take longer to make than a batch to shade.
  constexpr size_t kTask = 16 * kBatchCapacity;
  std::mutex mutex;
  ParallelFor((points.size() + kTask - 1) / kTask, settings.threads, [&](size_t task) {
    const auto room = std::make_unique<PointRoom>();
    RenderStats task_stats;
    const size_t end = std::min((task + 1) * kTask, points.size());
    for (size_t i = task * kTask; i < end; i += kBatchCapacity) {
      ShadePoints(plans, points.data() + i, std::min(kBatchCapacity, end - i), &radiance,
                  room.get(), &task_stats);
    }
    const std::lock_guard lock(mutex);
    stats->Add(task_stats);
  });
  return radiance;
}

std::vector<MaterialId> MaterialsOf(const Scene& scene, const Mesh& mesh) {
  const auto* split = std::get_if<SplitMaterial>(&scene.materials[mesh.material.index].model);
  return split == nullptr ? std::vector{mesh.material} : split->materials;
}

}  // namespace

ShadedMeshes ShadeMeshes(const Scene& scene, const RenderSettings& settings,
                         const SurfacePlan& surfaces, const DirectPlan& direct, Explanation* why) {
  const TracedShapes& shapes = direct.shapes;
  if (scene.meshes.empty() || shapes.intersector == nullptr) return {};
  ShadedMeshes shaded;
  shaded.radiance.resize(scene.meshes.size());
  size_t vertices = 0, triangles = 0;
  for (size_t i = 0; i < scene.meshes.size(); ++i) {
    const Mesh& mesh = scene.meshes[i];
    const bool flat = mesh.interpolation == Interpolation::kFlat;
    if (!flat && mesh.interpolation != Interpolation::kGouraud) continue;
    const auto first =
        static_cast<uint32_t>(scene.spheres.size()) + shapes.primitives.mesh_first_triangle[i];
    const std::vector<Point> points = flat ? FlatPoints(scene, shapes.camera, i, first)
                                           : VertexPoints(scene, shapes.camera, i, first);
    const size_t size = flat ? mesh.triangles.size() / 3 : mesh.positions.size();
    (flat ? triangles : vertices) += points.size();
    for (const MaterialId material : MaterialsOf(scene, mesh)) {
      shaded.radiance[i].push_back(
          ShadeMesh({surfaces, direct}, settings, points, size, material, &shaded.stats));
    }
  }
  const bool any = vertices + triangles > 0;
  why->items.push_back(
      {"shading of vertices and triangles", any,
       any ? fmt::format("{} vertices and {} triangles were shaded once", vertices, triangles)
           : "no mesh is interpolated by Gouraud's method, or flat"});
  if (!any) shaded.radiance.clear();
  return shaded;
}

}  // namespace nacre
