// SPDX-License-Identifier: Apache-2.0
#include "render/direct.h"

#include <algorithm>

#include "render/camera.h"
#include "render/lighting_kernel.h"
#include "render/sampled_lights.h"
#include "render/shadow_origins.h"

namespace nacre {
namespace {

// Whether any hit of the batch needs a shadow ray to the light.
bool CastsShadowRays(const DirectPlan& plan, const LightShadows& shadows, const HitBatch& hits) {
  if (!hits.one_primitive) return shadows.rays;
  return !NeverShadowed(shadows, hits.primitive[0]) &&
         plan.shapes.intersector->MayOcclude(shadows.occluders, hits);
}

// Sets the irradiance to 0 at hits that lie in the light's shadow. Only hits that the light can
// illuminate get a shadow ray.
void CastShadows(const DirectBatch& batch, const ShadingLight& light, const LightShadows& shadows) {
  const DirectPlan& plan = batch.plan;
  const HitBatch& hits = batch.hits();
  DirectRoom& room = batch.room;
  const Soa3<double>& origin = plan.offset_shadow_origins ? room.shadow_origin : hits.position;
  ShadowRayBatch& rays = room.shadow_rays;
  rays.light = shadows.occluders;
  rays.camera_extent = plan.shapes.camera_extent;
  // Without a branch on whether a hit is lit, which would be mispredicted.
  const bool all = hits.one_primitive && !NeverShadowed(shadows, hits.primitive[0]);
  size_t count = 0;
  for (size_t i = 0; i < batch.lit(); ++i) {
    room.shadow_hits[count] = static_cast<uint32_t>(i);
    const bool may_be = all || !NeverShadowed(shadows, hits.primitive[i]);
    count += static_cast<size_t>(may_be & (room.light.irradiance[i] > 0));
  }
  rays.count = count;
  batch.stats.shadow_rays += count;
  if (count == 0) return;
  FillShadowRays(light, hits, origin, room.shadow_hits, &rays);
  std::fill_n(rays.own_after.data(), count, plan.shapes.OwnAfter());
  plan.shapes.intersector->Occluded(&rays);
  for (size_t ray = 0; ray < rays.count; ++ray) {
    if (rays.occluded[ray] != 0) room.light.irradiance[room.shadow_hits[ray]] = 0;
  }
}

// Whether the kernels of the batch's materials evaluate the light, which casts no shadow here.
bool IsLeftToKernels(const DirectBatch& batch, const ShadingLight& light) {
  return EvaluatedInPlace(light) &&
         std::ranges::none_of(LitRuns(batch.surfaces), [](const MaterialRun& run) {
           return NeedsLightAtHits(*run.shading);
         });
}

void ShadeByPunctualLight(const DirectBatch& batch, const ShadingLight& light,
                          const LightShadows& shadows, ReflectedRadiance* radiance) {
  LightBatch* const on_hits = &batch.room.light;
  const bool shadow_rays = CastsShadowRays(batch.plan, shadows, batch.hits());
  const bool in_place = !shadow_rays && IsLeftToKernels(batch, light);
  if (!in_place) EvaluateLight(light, batch.hits(), batch.surface(), on_hits);
  HideUnreflectedLight(batch);
  batch.clock.Charge(Stage::kLight);
  if (shadow_rays) {
    CastShadows(batch, light, shadows);
    batch.clock.Charge(Stage::kShadow);
  }
  for (const MaterialRun& run : LitRuns(batch.surfaces)) {
    EvaluateBsdf({HitsOf(batch.surfaces, run), light, in_place ? nullptr : on_hits, radiance,
                  batch.plan.lights.components},
                 &batch.room.bsdf);
  }
  batch.stats.shades += batch.lit();
  batch.clock.Charge(Stage::kShade);
}

// Shades by the lights in their order.
void ShadeByPunctualLights(const DirectBatch& batch) {
  const std::vector<PlannedPunctualLight>& lights = batch.plan.lights.punctual;
  ReflectedRadiance& total = batch.radiance.total;
  if (lights.empty()) ClearRadiance(batch.lit(), &total);
  for (size_t i = 0; i < lights.size(); ++i) {
    const PlannedPunctualLight& planned = lights[i];
    ++batch.stats.light_batches;
    const bool is_first = i == 0;
    ReflectedRadiance& of_light = is_first ? total : batch.room.single;
    ShadeByPunctualLight(batch, planned.light, batch.plan.shadows.punctual[i], &of_light);
    if (planned.layer >= 0) AddToLightLayer(batch, of_light, planned.layer);
    if (!is_first) AddRadiance(batch, of_light);
  }
}

}  // namespace

void ShadeDirect(const DirectBatch& batch, const SampleNumbers* numbers) {
  batch.radiance.per_light.resize(batch.plan.lights.light_layer_count);
  if (batch.lit() == 0) return;
  for (Soa3<float>& layer : batch.radiance.per_light) ClearSoa(batch.lit(), &layer);
  if (batch.plan.offset_shadow_origins) OffsetShadowOrigins(batch);
  ShadeByPunctualLights(batch);
  if (!batch.plan.lights.sampled.empty()) ShadeBySampledLights(batch, *numbers);
}

void ShadeSky(const DirectPlan& plan, const FilmBatch& film, size_t hits, DirectRoom* room,
              BatchRadiance* radiance) {
  if (!plan.lights.sky || hits == film.count) return;
  MakeCameraRays(plan.shapes.camera, film, &room->sky_rays);
  SkyRadiance(plan.lights.sampled[*plan.lights.sky].light, room->sky_rays.direction, film.count,
              &radiance->sky);
}

}  // namespace nacre
