// SPDX-License-Identifier: Apache-2.0
#include "render/mesh_radiance.h"

#include <algorithm>
#include <memory>

#include <fmt/format.h>

#include "base/parallel.h"
#include "hit/shading_normal.h"
#include "render/mesh_points.h"
#include "render/tile.h"
#include "sampling/hash.h"
#include "scene/mesh.h"

namespace nacre {
namespace {

// Where a mesh is shaded: relative to the camera.
struct Point {
  Vec3d position, normal;
  uint32_t primitive;  // that it is on
  uint32_t index;      // of its vertex or triangle,
  uint32_t side;       // and the side of MeshRadiance
};

// Triangles on whose one side a vertex is, by its number; kNoTriangle: on none's.
constexpr uint32_t kNoTriangle = 0xffffffffu;
using SideTriangles = std::array<std::vector<uint32_t>, 2>;

// Which of a corner's two sides the camera sees, given the normal of the triangle on its side.
uint32_t SideOf(const TriangleRef& triangle, size_t corner, const Vec3d& seen_normal) {
  return triangle.mesh->normals[triangle.Vertex(corner)].dot(seen_normal) < 0 ? 1 : 0;
}

Vec3d SeenNormal(const RenderPlan& plan, const TriangleRef& triangle, const Corners& corners) {
  return FaceNormal(*triangle.mesh, triangle.triangle) * SideSeen(plan, corners);
}

std::vector<Point> FlatPoints(const RenderPlan& plan, size_t number, uint32_t first) {
  const Mesh& mesh = plan.scene->meshes[number];
  std::vector<Point> points;
  points.reserve(mesh.triangles.size() / 3);
  for (uint32_t i = 0; i < mesh.triangles.size() / 3; ++i) {
    const TriangleRef triangle{&mesh, number, i};
    const Corners corners = CornersOf(plan, triangle);
    const Vec3d normal = SeenNormal(plan, triangle, corners);
    if (normal == Vec3d(0, 0, 0)) continue;  // nothing hits it
    points.push_back({(corners[0] + corners[1] + corners[2]) / 3, normal, first + i, i, 0});
  }
  return points;
}

std::vector<Point> VertexPoints(const RenderPlan& plan, size_t number, uint32_t first) {
  const Mesh& mesh = plan.scene->meshes[number];
  SideTriangles seen;
  for (std::vector<uint32_t>& side : seen) side.assign(mesh.positions.size(), kNoTriangle);
  for (uint32_t i = 0; i < mesh.triangles.size() / 3; ++i) {
    const TriangleRef triangle{&mesh, number, i};
    const Vec3d normal = SeenNormal(plan, triangle, CornersOf(plan, triangle));
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
      points.push_back({mesh.positions[i] - plan.scene->camera.position,
                        mesh.normals[i] * (side == 0 ? 1.0 : -1.0), first + seen[side][i], i,
                        side});
    }
  }
  return points;
}

// Makes hits of up to kBatchCapacity points, which the camera looks at.
void MakeHits(const RenderPlan& plan, const Point* points, size_t count, TileScratch* s) {
  const bool parallel = plan.camera.projection == Projection::kOrthographic;
  s->hits.count = count;
  s->hits.one_primitive = false;
  for (size_t i = 0; i < RoundUp(count, kBatchPadding); ++i) {
    const Point& point = points[std::min(i, count - 1)];
    Vec3d to_view = parallel ? -plan.camera.forward : -point.position.normalized();
    if (to_view == Vec3d(0, 0, 0)) to_view = point.normal;  // the camera is at the vertex
    const auto put = [i](const Vec3d& v, Soa3<double>* to) {
      to->x[i] = v.x;
      to->y[i] = v.y;
      to->z[i] = v.z;
    };
    put(point.position, &s->hits.position);
    put(point.normal, &s->hits.normal);
    put(GrazingView(point.normal, to_view), &s->hits.to_view);
    s->hits.primitive[i] = point.primitive;
    s->hits.ray[i] = static_cast<uint32_t>(i);
  }
  PrepareSurface(s->hits, &s->surface);
}

// Sums, in double, of the samples of a batch of points.
struct Sums {
  std::vector<Vec3d> diffuse, specular;
  std::vector<std::vector<Vec3d>> lights;

  Sums(size_t count, size_t light_count)
      : diffuse(count, Vec3d(0)),
        specular(count, Vec3d(0)),
        lights(light_count, std::vector<Vec3d>(count, Vec3d(0))) {}
};

void AddTo(const Soa3<float>& from, std::vector<Vec3d>* sums) {
  for (size_t i = 0; i < sums->size(); ++i) (*sums)[i] += Vec3d(from.x[i], from.y[i], from.z[i]);
}

// How often each point is shaded: lights that are sampled take as many samples as a pixel.
int SamplesOf(const RenderPlan& plan) {
  return plan.sampled_lights.empty() ? 1 : static_cast<int>(plan.pairs.samples);
}

void NumberPoints(const Point* points, size_t count, int sample, SampleNumbers* numbers) {
  numbers->pixel_count = count;
  for (uint32_t i = 0; i < count; ++i) {
    numbers->number[i] = static_cast<uint32_t>(sample);
    numbers->pixel[i] = i;
    numbers->seeds[i] = Combine(points[i].primitive, points[i].index);
  }
}

void ShadePoints(const RenderPlan& plan, const Point* points, size_t count, MeshRadiance* to,
                 TileScratch* s) {
  RenderStats stats;
  StageClock clock(nullptr);
  MakeHits(plan, points, count, s);
  s->runs = {{to->material, 0, count, false}};
  if (!plan.sampled_lights.empty() && !s->sampled) s->sampled = std::make_unique<SampledScratch>();
  Sums sums(count, plan.light_layer_count);
  const int samples = SamplesOf(plan);
  for (int k = 0; k < samples; ++k) {
    if (s->sampled) NumberPoints(points, count, k, &s->sampled->numbers);
    ShadeHits(plan, s, &clock, &stats);
    AddTo(s->total.diffuse, &sums.diffuse);
    AddTo(s->total.specular, &sums.specular);
    for (size_t l = 0; l < sums.lights.size(); ++l) AddTo(s->per_light[l], &sums.lights[l]);
  }
  for (size_t i = 0; i < count; ++i) {
    SideRadiance& side = to->sides[points[i].side];
    const auto mean = [&](const std::vector<Vec3d>& sum) { return Vec3f(sum[i] / samples); };
    side.diffuse[points[i].index] = mean(sums.diffuse);
    side.specular[points[i].index] = mean(sums.specular);
    for (size_t l = 0; l < sums.lights.size(); ++l) {
      side.lights[l][points[i].index] = mean(sums.lights[l]);
    }
  }
}

MeshRadiance ShadeMesh(const RenderPlan& plan, const RenderSettings& settings,
                       const std::vector<Point>& points, size_t size, MaterialId material) {
  MeshRadiance radiance;
  radiance.material = material;
  for (uint32_t side = 0; side < 2; ++side) {
    const bool is_seen = std::any_of(points.begin(), points.end(),
                                     [&](const Point& point) { return point.side == side; });
    if (!is_seen) continue;
    SideRadiance& of = radiance.sides[side];
    of.diffuse.resize(size);
    of.specular.resize(size);
    of.lights.assign(plan.light_layer_count, std::vector<Vec3f>(size));
  }
  // Several batches a task: its buffers take longer to make than one batch.
  constexpr size_t kTask = 16 * kBatchCapacity;
  ParallelFor((points.size() + kTask - 1) / kTask, settings.threads, [&](size_t task) {
    const auto scratch = std::make_unique<TileScratch>();
    const size_t end = std::min((task + 1) * kTask, points.size());
    for (size_t i = task * kTask; i < end; i += kBatchCapacity) {
      ShadePoints(plan, points.data() + i, std::min(kBatchCapacity, end - i), &radiance,
                  scratch.get());
    }
  });
  return radiance;
}

std::vector<MaterialId> MaterialsOf(const Scene& scene, const Mesh& mesh) {
  const auto* split = std::get_if<SplitMaterial>(&scene.materials[mesh.material.index].model);
  return split == nullptr ? std::vector{mesh.material} : split->materials;
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
void ForEachArray(TileScratch* s, const PutArray& put) {
  put(
      [](const SideRadiance& side) -> const auto& { return side.diffuse; }, &s->total.diffuse);
  put(
      [](const SideRadiance& side) -> const auto& { return side.specular; }, &s->total.specular);
  for (size_t l = 0; l < s->per_light.size(); ++l) {
    put(
        [l](const SideRadiance& side) -> const auto& { return side.lights[l]; }, &s->per_light[l]);
  }
}

void InterpolateHit(const RenderPlan& plan, const TriangleRef& triangle,
                    const MeshRadiance& radiance, size_t hit, TileScratch* s) {
  if (triangle.mesh->interpolation == Interpolation::kFlat) {
    ForEachArray(s, [&](const auto& array, Soa3<float>* to) {
      Put(Vec3d(array(radiance.sides[0])[triangle.triangle]), hit, to);
    });
    return;
  }
  const Soa3<double>& p = s->hits.position;
  const Corners corners = CornersOf(plan, triangle);
  const Vec3d normal = SeenNormal(plan, triangle, corners);
  const std::array<uint32_t, 3> sides = {SideOf(triangle, 0, normal), SideOf(triangle, 1, normal),
                                         SideOf(triangle, 2, normal)};
  const Vec3d weights = WeightsAt(corners, Vec3d(p.x[hit], p.y[hit], p.z[hit]));
  const Between between(triangle, radiance, sides, weights);
  ForEachArray(s, [&](const auto& array, Soa3<float>* to) { Put(between.Mean(array), hit, to); });
}

}  // namespace

void ShadeMeshes(const RenderSettings& settings, RenderPlan* plan) {
  const Scene& scene = *plan->scene;
  std::vector<std::vector<MeshRadiance>> all(scene.meshes.size());
  size_t vertices = 0, triangles = 0;
  for (size_t i = 0; i < scene.meshes.size(); ++i) {
    const Mesh& mesh = scene.meshes[i];
    const bool flat = mesh.interpolation == Interpolation::kFlat;
    if (!flat && mesh.interpolation != Interpolation::kGouraud) continue;
    const auto first = static_cast<uint32_t>(scene.spheres.size()) + plan->mesh_first_triangle[i];
    const std::vector<Point> points =
        flat ? FlatPoints(*plan, i, first) : VertexPoints(*plan, i, first);
    const size_t size = flat ? mesh.triangles.size() / 3 : mesh.positions.size();
    (flat ? triangles : vertices) += points.size();
    for (const MaterialId material : MaterialsOf(scene, mesh)) {
      all[i].push_back(ShadeMesh(*plan, settings, points, size, material));
    }
  }
  const bool any = vertices + triangles > 0;
  plan->items.push_back(
      {"shading of vertices and triangles", any,
       any ? fmt::format("{} vertices and {} triangles were shaded once", vertices, triangles)
           : "no mesh is interpolated by Gouraud's method, or flat"});
  if (any) plan->mesh_radiance = std::move(all);
}

bool IsInterpolated(const RenderPlan& plan, uint32_t primitive) {
  return !plan.mesh_radiance.empty() && primitive >= plan.scene->spheres.size() &&
         !plan.mesh_radiance[TriangleOf(plan, primitive).number].empty();
}

void Interpolate(const RenderPlan& plan, TileScratch* scratch) {
  TileScratch& s = *scratch;
  for (const MaterialRun& run : s.runs) {
    if (!run.interpolated) continue;
    for (size_t hit = run.begin; hit < run.end; ++hit) {
      const TriangleRef triangle = TriangleOf(plan, s.hits.primitive[hit]);
      const std::vector<MeshRadiance>& sets = plan.mesh_radiance[triangle.number];
      const auto found = std::find_if(sets.begin(), sets.end(), [&](const MeshRadiance& set) {
        return set.material == run.material;
      });
      if (found != sets.end()) {
        InterpolateHit(plan, triangle, *found, hit, &s);
      } else {  // the black back of what emits in front only
        ForEachArray(&s, [&](const auto&, Soa3<float>* to) { Put(Vec3d(0), hit, to); });
      }
    }
  }
}

}  // namespace nacre
