// SPDX-License-Identifier: Apache-2.0
#include "render/hits.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "render/camera.h"

namespace nacre {
namespace {

// The parameter t of a hit on its ray, and a bound of its rounding error.
struct RayDepth {
  double t, error;
};

RayDepth DepthOf(const RayBatch& rays, size_t ray, const Vec3d& position) {
  const Vec3d origin = VectorAt(rays.origin, ray), direction = VectorAt(rays.direction, ray);
  const double inverse_dd = 1 / direction.dot(direction);
  const double t = (position - origin).dot(direction) * inverse_dd;
  const double extent = SumOfAbs(position) + SumOfAbs(origin);
  return {t, 1e-12 * (t + extent * std::sqrt(inverse_dd))};
}

void TraceByTree(const HitsPlan& plan, const FilmBatch& film, bool positions, TraceRoom* room,
                 CameraHits* hits) {
  RayBatch& rays = room->rays;
  MakeCameraRays(plan.shapes.camera, film, &rays);
  plan.shapes.intersector->Closest(rays, &room->closest);
  size_t count = 0;
  for (size_t ray = 0; ray < rays.count; ++ray) {
    if (room->closest.primitive[ray] == kNoPrimitive) continue;
    room->hit_rays[count++] = static_cast<uint32_t>(ray);
  }
  hits->batch.count = 0;
  if (count == 0) return;
  plan.shapes.intersector->Refine(
      rays, room->closest, room->hit_rays.data(), count,
      {&hits->batch, &hits->directions, plan.arrays.exact_directions, positions});
}

// Finds the nearest triangles in front of the hits on spheres, or behind them by no more than the
// rounding error.
void FindNearerTriangles(const HitsPlan& plan, const FilmBatch& film, const HitBatch& on_spheres,
                         TraceRoom* room) {
  MakeCameraRays(plan.shapes.camera, film, &room->rays);
  std::fill(room->closest.t.begin(), room->closest.t.end(),
            std::numeric_limits<double>::infinity());
  for (size_t i = 0; i < on_spheres.count; ++i) {
    const size_t ray = on_spheres.ray[i];
    const RayDepth depth = DepthOf(room->rays, ray, VectorAt(on_spheres.position, i));
    room->closest.t[ray] = depth.t + depth.error;
  }
  plan.shapes.intersector->NearerTriangles(room->rays, &room->closest);
}

// Whether hit i on a sphere is in front of the triangle that its ray hits at t, or at the same
// depth: of equal depths the primitive with the lower number counts. If t is within the rounding
// error, the exact test decides.
bool SphereHitIsFirst(const HitsPlan& plan, const RayBatch& rays, const HitBatch& on_spheres,
                      size_t i, double t) {
  const size_t ray = on_spheres.ray[i];
  const RayDepth depth = DepthOf(rays, ray, VectorAt(on_spheres.position, i));
  if (t < depth.t - depth.error) return false;
  return plan.shapes.intersector->SphereIsFirst(on_spheres.primitive[i], rays, ray, t);
}

void CopyHit(const CameraHits& from, size_t i, bool exact, size_t k, CameraHits* to) {
  to->batch.ray[k] = from.batch.ray[i];
  to->batch.primitive[k] = from.batch.primitive[i];
  SetVector(VectorAt(from.batch.position, i), k, &to->batch.position);
  SetVector(VectorAt(from.directions.normal, i), k, &to->directions.normal);
  SetVector(VectorAt(from.directions.to_view, i), k, &to->directions.to_view);
  if (!exact) return;
  SetVector(VectorAt(from.batch.normal, i), k, &to->batch.normal);
  SetVector(VectorAt(from.batch.to_view, i), k, &to->batch.to_view);
}

// Merges the hits on triangles with the hits on spheres that no triangle hides, ordered by ray.
void JoinHits(const HitsPlan& plan, TraceRoom::Triangles* triangles, CameraHits* hits) {
  const HitBatch& spheres = hits->batch;
  const CameraHits& on_triangles = triangles->hits;
  CameraHits& to = triangles->joined;
  size_t i = 0, j = 0, count = 0;
  const auto put = [&](const CameraHits& from, size_t k) {
    CopyHit(from, k, plan.arrays.exact_directions, count++, &to);
  };
  while (i < spheres.count || j < on_triangles.batch.count) {
    if (i < spheres.count && triangles->hides_sphere[i] != 0) {
      ++i;
    } else if (j == on_triangles.batch.count ||
               (i < spheres.count && spheres.ray[i] < on_triangles.batch.ray[j])) {
      put(*hits, i++);
    } else {
      put(on_triangles, j++);
    }
  }
  to.batch.count = count;
  to.batch.one_primitive = false;
  for (size_t k = count; k < RoundUp(count, kBatchPadding); ++k) {
    CopyHit(to, count - 1, plan.arrays.exact_directions, k, &to);
  }
  std::swap(hits->batch, to.batch);
  std::swap(hits->directions, to.directions);
}

// Adds hits on triangles to the batch of hits on spheres.
void AddTriangles(const HitsPlan& plan, const FilmBatch& film, TraceRoom* room, CameraHits* hits) {
  const HitBatch& spheres = hits->batch;
  FindNearerTriangles(plan, film, spheres, room);
  if (!room->triangles) room->triangles = std::make_unique<TraceRoom::Triangles>();
  TraceRoom::Triangles& triangles = *room->triangles;
  size_t count = 0, i = 0;
  for (size_t ray = 0; ray < room->rays.count; ++ray) {
    const bool on_sphere = i < spheres.count && spheres.ray[i] == ray;
    const bool on_triangle =
        room->closest.primitive[ray] != kNoPrimitive &&
        !(on_sphere && SphereHitIsFirst(plan, room->rays, spheres, i, room->closest.t[ray]));
    if (on_triangle) room->hit_rays[count++] = static_cast<uint32_t>(ray);
    if (on_sphere) triangles.hides_sphere[i++] = on_triangle ? 1 : 0;
  }
  if (count == 0) return;
  plan.shapes.intersector->Refine(
      room->rays, room->closest, room->hit_rays.data(), count,
      {&triangles.hits.batch, &triangles.hits.directions, plan.arrays.exact_directions});
  JoinHits(plan, &triangles, hits);
}

}  // namespace

void TraceCamera(const HitsPlan& plan, const TileShapes& shapes, const FilmBatch& film,
                 TraceRoom* room, CameraHits* hits) {
  hits->batch.count = 0;
  hits->has_positions = shapes.positions;
  hits->has_exact_directions = plan.arrays.exact_directions;
  if (!shapes.any) return;
  if (!plan.trace.by_bins) return TraceByTree(plan, film, shapes.positions, room, hits);
  plan.shapes.intersector->HitsInTile(
      shapes.spheres, film,
      {&hits->batch, &hits->directions, plan.arrays.exact_directions, shapes.positions});
  if (shapes.triangles) AddTriangles(plan, film, room, hits);
}

}  // namespace nacre
