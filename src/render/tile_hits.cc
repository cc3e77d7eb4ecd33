// SPDX-License-Identifier: Apache-2.0
#include "render/tile_hits.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "render/hit_places.h"
#include "render/tile.h"

namespace nacre {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Vec3d At(const Soa3<double>& soa, size_t i) { return {soa.x[i], soa.y[i], soa.z[i]}; }

double SumOfAbs(const Vec3d& v) { return std::abs(v.x) + std::abs(v.y) + std::abs(v.z); }

// Where on its ray a hit lies, but for rounding, and a bound of that.
struct Place {
  double t, slack;
};

Place PlaceOf(const RayBatch& rays, size_t ray, const Vec3d& position) {
  const Vec3d origin = At(rays.origin, ray), direction = At(rays.direction, ray);
  const double inverse_dd = 1 / direction.dot(direction);
  const double t = (position - origin).dot(direction) * inverse_dd;
  const double reach = SumOfAbs(position) + SumOfAbs(origin);
  return {t, 1e-12 * (t + reach * std::sqrt(inverse_dd))};
}

void FindByEmbree(const RenderPlan& plan, const HitsTo& to, TileScratch* s) {
  MakeCameraRays(plan.camera, s->samples.x.data(), s->samples.y.data(), s->samples.count, &s->rays);
  plan.intersector->Closest(s->rays, &s->closest);
  size_t count = 0;
  for (size_t ray = 0; ray < s->rays.count; ++ray) {
    if (s->closest.primitive[ray] == kNoPrimitive) continue;
    s->hit_rays[count++] = static_cast<uint32_t>(ray);
  }
  s->hits.count = 0;
  if (count > 0) plan.intersector->Refine(s->rays, s->closest, s->hit_rays.data(), count, to);
}

// Finds the triangles that lie before the hits on spheres, which may be wrong by what only the
// exact test tells.
void FindNearerTriangles(const RenderPlan& plan, TileScratch* s) {
  MakeCameraRays(plan.camera, s->samples.x.data(), s->samples.y.data(), s->samples.count, &s->rays);
  std::fill(s->closest.t.begin(), s->closest.t.end(), kInfinity);
  for (size_t i = 0; i < s->hits.count; ++i) {
    const size_t ray = s->hits.ray[i];
    const Place place = PlaceOf(s->rays, ray, At(s->hits.position, i));
    s->closest.t[ray] = place.t + place.slack;
  }
  plan.intersector->NearerTriangles(s->rays, &s->closest);
}

// Whether the sphere's hit i is before the triangle that its ray meets at t, or at the same depth:
// spheres have the lower ids.
bool SphereIsFirst(const RenderPlan& plan, const TileScratch& s, size_t i, double t) {
  const size_t ray = s.hits.ray[i];
  const Place place = PlaceOf(s.rays, ray, At(s.hits.position, i));
  if (t < place.t - place.slack) return false;
  return plan.intersector->SphereIsFirst(s.hits.primitive[i], s.rays, ray, t);
}

template <class T>
void Copy(const Soa3<T>& from, size_t i, Soa3<T>* to, size_t k) {
  to->x[k] = from.x[i];
  to->y[k] = from.y[i];
  to->z[k] = from.z[i];
}

void CopyHit(const HitBatch& from, const HitDirections& directions, size_t i, size_t k,
             const HitsTo& to) {
  to.hits->ray[k] = from.ray[i];
  to.hits->primitive[k] = from.primitive[i];
  Copy(from.position, i, &to.hits->position, k);
  Copy(directions.normal, i, &to.directions->normal, k);
  Copy(directions.to_view, i, &to.directions->to_view, k);
  if (!to.exact) return;
  Copy(from.normal, i, &to.hits->normal, k);
  Copy(from.to_view, i, &to.hits->to_view, k);
}

// Puts the hits on triangles among those on spheres that they do not hide, by their rays.
void JoinHits(const RenderPlan& plan, TileScratch* s) {
  const TriangleHits& triangles = *s->triangle_hits;
  const HitsTo to{&s->unsorted_hits, &s->unsorted_directions, true, plan.exact_directions};
  size_t i = 0, j = 0, count = 0;
  const auto put = [&](const HitBatch& hits, const HitDirections& directions, size_t k) {
    CopyHit(hits, directions, k, count++, to);
  };
  while (i < s->hits.count || j < triangles.hits.count) {
    if (i < s->hits.count && triangles.hidden[i] != 0) {
      ++i;
    } else if (j == triangles.hits.count ||
               (i < s->hits.count && s->hits.ray[i] < triangles.hits.ray[j])) {
      put(s->hits, s->surface, i++);
    } else {
      put(triangles.hits, triangles.directions, j++);
    }
  }
  to.hits->count = count;
  to.hits->one_primitive = false;
  for (size_t k = count; k < RoundUp(count, kBatchPadding); ++k) {
    CopyHit(*to.hits, *to.directions, count - 1, k, to);
  }
  std::swap(s->hits, s->unsorted_hits);
  std::swap(static_cast<HitDirections&>(s->surface), s->unsorted_directions);
}

// Takes the triangles' hits into the batch of hits on spheres.
void AddTriangles(const RenderPlan& plan, TileScratch* s) {
  FindNearerTriangles(plan, s);
  if (!s->triangle_hits) s->triangle_hits = std::make_unique<TriangleHits>();
  TriangleHits& triangles = *s->triangle_hits;
  size_t count = 0, i = 0;
  for (size_t ray = 0; ray < s->rays.count; ++ray) {
    const bool on_sphere = i < s->hits.count && s->hits.ray[i] == ray;
    const bool on_triangle = s->closest.primitive[ray] != kNoPrimitive &&
                             !(on_sphere && SphereIsFirst(plan, *s, i, s->closest.t[ray]));
    if (on_triangle) triangles.rays[count++] = static_cast<uint32_t>(ray);
    if (on_sphere) triangles.hidden[i++] = on_triangle ? 1 : 0;
  }
  if (count == 0) return;
  plan.intersector->Refine(s->rays, s->closest, triangles.rays.data(), count,
                           {&triangles.hits, &triangles.directions, true, plan.exact_directions});
  JoinHits(plan, s);
}

}  // namespace

bool EnterShapes(const RenderPlan& plan, const Window& tile, TileScratch* scratch) {
  TileScratch& s = *scratch;
  const TileRays rays = plan.adaptive.max_error > 0 ? TileRays::kAny : TileRays::kSamples;
  const bool spheres = !plan.scene->spheres.empty() &&
                       (!plan.binned || plan.intersector->EnterTile(tile, rays, &s.candidates));
  s.triangles_in_sight =
      std::any_of(plan.mesh_windows.begin(), plan.mesh_windows.end(),
                  [&](const Window& window) { return !Intersect(window, tile).empty(); });
  if (spheres) s.positions = NeedsPositions(plan, s.candidates);
  return spheres || s.triangles_in_sight;
}

void FindHits(const RenderPlan& plan, TileScratch* scratch) {
  TileScratch& s = *scratch;
  const HitsTo to{&s.hits, &s.surface, s.positions, plan.exact_directions};
  if (!plan.tiles) return FindByEmbree(plan, to, &s);
  plan.intersector->HitsInTile(s.candidates, s.samples, to);
  if (s.triangles_in_sight) AddTriangles(plan, &s);
}

}  // namespace nacre
