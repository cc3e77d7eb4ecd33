// SPDX-License-Identifier: Apache-2.0
#include "render/sampled_shadows.h"

#include <algorithm>
#include <cmath>

#include "render/lighting_kernel.h"

namespace nacre {
namespace {

// Moves the start of a hit's shadow ray to its offset origin, and keeps its end.
void OffsetRay(const Soa3<double>& from, const Soa3<double>& origin, size_t i,
               ShadowRayBatch* rays) {
  const Vec3d offset = VectorAt(origin, i) - VectorAt(from, i);
  if (offset == Vec3d(0, 0, 0) || rays->t_max[i] == 0) return;
  SetVector(VectorAt(origin, i), i, &rays->origin);
  const double distance = rays->t_max[i];
  if (std::isinf(distance)) return;
  SetVector(VectorAt(rays->direction, i) * distance - offset, i, &rays->direction);
  rays->t_max[i] = 1;
}

// Makes a ray for each hit, because most hits need one. The other rays are inactive. Returns the
// number of active rays.
size_t MakeSampledShadowRays(const DirectBatch& batch, const PlannedSampledLight& planned,
                             const LightShadows& shadows, const LightDirections& directions) {
  const HitBatch& hits = batch.hits();
  DirectRoom& room = batch.room;
  ShadowRayBatch& rays = room.shadow_rays;
  rays.count = batch.lit();
  std::copy_n(hits.primitive.data(), rays.count, rays.primitive.data());
  CopySoa(hits.position, rays.count, &rays.origin);
  AimShadowRays(directions, room.light.irradiance.data(), rays.count, &rays);
  FindEnds(planned.light, hits, directions, &rays.t_max);
  const bool all = shadows.trace_all || shadows.shadowed.empty();
  size_t active = 0;
  for (size_t i = 0; i < rays.count; ++i) {
    if (!all && NeverShadowed(shadows, hits.primitive[i])) rays.t_max[i] = 0;
    active += rays.t_max[i] > 0 ? 1 : 0;
  }
  if (!batch.plan.offset_shadow_origins) return active;
  for (size_t i = 0; i < rays.count; ++i) OffsetRay(hits.position, room.shadow_origin, i, &rays);
  return active;
}

}  // namespace

void CastSampledShadows(const DirectBatch& batch, const PlannedSampledLight& planned,
                        const LightShadows& shadows, const LightDirections& directions) {
  const size_t active = MakeSampledShadowRays(batch, planned, shadows, directions);
  batch.stats.shadow_rays += active;
  if (active == 0) return;
  ShadowRayBatch& rays = batch.room.shadow_rays;
  rays.light = shadows.occluders;
  std::fill_n(rays.own_after.data(), rays.count, batch.plan.shapes.OwnAfter());
  rays.target = planned.primitives;
  rays.camera_extent = batch.plan.shapes.camera_extent;
  batch.plan.shapes.intersector->Occluded(&rays);
  rays.target = {};
  float* const irradiance = batch.room.light.irradiance.data();
  const uint8_t* const occluded = rays.occluded.data();
  for (size_t i = 0; i < rays.count; ++i) {
    irradiance[i] = occluded[i] != 0 ? 0.0f : irradiance[i];
  }
}

}  // namespace nacre
