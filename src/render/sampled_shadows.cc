// SPDX-License-Identifier: Apache-2.0
#include "render/sampled_shadows.h"

#include <algorithm>
#include <cmath>

#include "render/sampled_kernel.h"
#include "render/tile.h"

namespace nacre {
namespace {

// Lets the shadow ray of a hit start where those of its mesh do, and end at the same point.
void LiftRay(const TileScratch& s, size_t i, ShadowRayBatch* rays) {
  const Soa3<double>& from = s.hits.position;
  const Soa3<double>& origin = s.shadow_origin;
  const Vec3d lift(origin.x[i] - from.x[i], origin.y[i] - from.y[i], origin.z[i] - from.z[i]);
  if (lift == Vec3d(0, 0, 0) || rays->t_max[i] == 0) return;
  rays->origin.x[i] = origin.x[i];
  rays->origin.y[i] = origin.y[i];
  rays->origin.z[i] = origin.z[i];
  const double distance = rays->t_max[i];
  if (std::isinf(distance)) return;
  rays->direction.x[i] = rays->direction.x[i] * distance - lift.x;
  rays->direction.y[i] = rays->direction.y[i] * distance - lift.y;
  rays->direction.z[i] = rays->direction.z[i] * distance - lift.z;
  rays->t_max[i] = 1;
}

// One ray a hit, most of which need one; the others end where they start. Returns how many do not.
size_t MakeSampledShadowRays(const RenderPlan& plan, const PlannedSampledLight& planned,
                             TileScratch* scratch) {
  TileScratch& s = *scratch;
  const HitBatch& hits = s.hits;
  ShadowRayBatch& rays = s.shadow_rays;
  rays.count = hits.count;
  std::copy_n(hits.primitive.data(), hits.count, rays.primitive.data());
  CopySoa(hits.position, hits.count, &rays.origin);
  AimShadowRays(s.sampled->directions, s.light.irradiance.data(), hits.count, &rays);
  FindEnds(planned.light, hits, s.sampled->directions, &rays.t_max);
  const bool all = planned.trace_all || planned.shadowed.empty();
  size_t asked = 0;
  for (size_t i = 0; i < hits.count; ++i) {
    if (!all && NeverShadowed(planned, hits.primitive[i])) rays.t_max[i] = 0;
    asked += rays.t_max[i] > 0 ? 1 : 0;
  }
  if (!plan.lift_shadows) return asked;
  for (size_t i = 0; i < hits.count; ++i) LiftRay(s, i, &rays);
  return asked;
}

}  // namespace

void CastSampledShadows(const RenderPlan& plan, const PlannedSampledLight& planned,
                        TileScratch* scratch, RenderStats* stats) {
  TileScratch& s = *scratch;
  const size_t asked = MakeSampledShadowRays(plan, planned, scratch);
  stats->shadow_rays += asked;
  if (asked == 0) return;
  ShadowRayBatch& rays = s.shadow_rays;
  rays.light = planned.occluders;
  rays.outward = plan.eye_outside;
  rays.target = planned.primitives;
  rays.end_reach = plan.camera_reach;
  plan.intersector->Occluded(&rays);
  rays.target = {};
  float* const irradiance = s.light.irradiance.data();
  const uint8_t* const occluded = rays.occluded.data();
  for (size_t i = 0; i < rays.count; ++i) {
    irradiance[i] = occluded[i] != 0 ? 0.0f : irradiance[i];
  }
}

}  // namespace nacre
