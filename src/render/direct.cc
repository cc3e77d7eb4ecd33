// SPDX-License-Identifier: Apache-2.0
#include "render/direct.h"

#include "render/camera.h"
#include "render/mapped_horizon.h"
#include "render/mesh_radiance.h"
#include "render/sampled_lights.h"
#include "render/shadow_origins.h"
#include "render/shadow_rays_kernel.h"

namespace nacre {
namespace {

// Whether any hit of the batch needs a shadow ray to the light.
bool CastsShadowRays(const DirectPlan& plan, const PlannedPunctualLight& planned,
                     const HitBatch& hits) {
  if (!hits.one_primitive) return planned.shadow_rays;
  return !NeverShadowed(planned, hits.primitive[0]) &&
         plan.intersector->MayOcclude(planned.occluders, hits);
}

// Sets the irradiance to 0 at hits that lie in the light's shadow. Only hits that the light can
// illuminate get a shadow ray.
void CastShadows(const DirectBatch& batch, const PlannedPunctualLight& planned) {
  const DirectPlan& plan = batch.plan;
  const HitBatch& hits = batch.hits();
  DirectRoom& room = batch.room;
  const Soa3<double>& origin = plan.offset_shadow_origins ? room.shadow_origin : hits.position;
  ShadowRayBatch& rays = room.shadow_rays;
  rays.light = planned.occluders;
  rays.outward = plan.eye_outside;
  rays.camera_extent = plan.camera_extent;
  // Without a branch on whether a hit is lit, which would be mispredicted.
  const bool all = hits.one_primitive && !NeverShadowed(planned, hits.primitive[0]);
  size_t count = 0;
  for (size_t i = 0; i < batch.lit(); ++i) {
    room.shadow_hits[count] = static_cast<uint32_t>(i);
    const bool may_be = all || !NeverShadowed(planned, hits.primitive[i]);
    count += static_cast<size_t>(may_be & (room.light.irradiance[i] > 0));
  }
  rays.count = count;
  batch.stats.shadow_rays += count;
  if (count == 0) return;
  FillShadowRays(planned.light, hits, origin, room.shadow_hits, &rays);
  plan.intersector->Occluded(&rays);
  for (size_t ray = 0; ray < rays.count; ++ray) {
    if (rays.occluded[ray] != 0) room.light.irradiance[room.shadow_hits[ray]] = 0;
  }
}

// Shades all lit runs. Where normals are mapped, `lights` is a single light that has been
// evaluated.
void ShadeRuns(const DirectBatch& batch, std::span<const LightOnBatch> lights, OutputMode output,
               ReflectedRadiance* radiance) {
  const LitHits lit{batch.hits(), batch.surface(), lights, batch.surfaces.textures.get(), output};
  for (const MaterialRun& run : LitRuns(batch.surfaces)) {
    ShadeRun(*run.shading, lit, run.begin, run.end, &batch.room.shade, radiance);
    if (batch.surface().turned) AddMirroredLobe(batch, run, *lights[0].light, output, radiance);
  }
}

// A light that needs a pass of its own: one with shadow rays, with a layer of its own, or of a form
// that the kernels do not evaluate.
void ShadeByPunctualLight(const DirectBatch& batch, const PlannedPunctualLight& planned,
                          bool shadow_rays, OutputMode output) {
  DirectRoom& room = batch.room;
  EvaluateLight(planned.light, batch.hits(), batch.surface(), &room.light);
  if (batch.surface().turned) HideLightsBelowHorizon(batch);
  batch.clock.Charge(Stage::kLight);
  if (shadow_rays) {
    CastShadows(batch, planned);
    batch.clock.Charge(Stage::kShadow);
  }
  const LightOnBatch light{&planned.light, &room.light};
  // The radiance of such a light is summed by itself before it is added to that of other lights,
  // whether or not a layer is rendered: layers must not change bits.
  const bool apart = planned.layer >= 0 || batch.surface().turned;
  if (!apart || batch.plan.one_light) {
    ShadeRuns(batch, {&light, 1}, output, &batch.radiance.total);
    if (planned.layer >= 0) AddToLightLayer(batch, batch.radiance.total, planned.layer);
  } else {
    ShadeRuns(batch, {&light, 1}, OutputMode::kOverwrite, &room.single);
    AddLightRadiance(batch, room.single, planned.layer);
  }
}

// Shades by the lights in their order. Consecutive lights that need no pass of their own are shaded
// by one call of the kernels.
void ShadeByPunctualLights(const DirectBatch& batch) {
  const DirectPlan& plan = batch.plan;
  const HitBatch& hits = batch.hits();
  const BatchBounds bounds = plan.cull_lights ? BoundHits(hits, batch.surface()) : BatchBounds{};
  batch.clock.Charge(Stage::kLight);
  std::vector<LightOnBatch>& light_group = batch.room.light_group;
  light_group.clear();
  bool dark = true;  // the total has not been written yet
  const auto output = [&] { return dark ? plan.output : OutputMode::kAccumulate; };
  const auto shade_group = [&] {
    if (light_group.empty()) return;
    ShadeRuns(batch, light_group, output(), &batch.radiance.total);
    light_group.clear();
    dark = false;
  };
  const auto clear_if_dark = [&] {
    if (dark) ClearRadiance(batch.lit(), &batch.radiance.total);
    dark = false;
  };
  for (const PlannedPunctualLight& planned : plan.lights) {
    ++batch.stats.light_batches;
    if (plan.cull_lights && !MayIlluminate(planned.geometry, bounds)) {
      ++batch.stats.culled_lights;
      continue;
    }
    const bool shadow_rays = CastsShadowRays(plan, planned, hits);
    if (!shadow_rays && planned.layer < 0 && !batch.surface().turned &&
        EvaluatedInPlace(planned.light)) {
      light_group.push_back({&planned.light, nullptr});
    } else {
      shade_group();
      const bool apart = planned.layer >= 0 || batch.surface().turned;
      if (apart && !plan.one_light) clear_if_dark();
      ShadeByPunctualLight(batch, planned, shadow_rays, output());
      dark = false;
    }
    batch.stats.shades += batch.lit();
  }
  shade_group();
  clear_if_dark();
  batch.clock.Charge(Stage::kShade);
}

// Everything except the coats over the hits.
void ShadeSurfaces(const DirectBatch& batch, const SampleNumbers* numbers) {
  batch.radiance.per_light.resize(batch.plan.light_layer_count);
  if (batch.lit() > 0) {
    for (Soa3<float>& layer : batch.radiance.per_light) ClearSoa(batch.lit(), &layer);
    if (batch.plan.offset_shadow_origins) OffsetShadowOrigins(batch);
    ShadeByPunctualLights(batch);
    if (!batch.plan.sampled_lights.empty()) ShadeBySampledLights(batch, *numbers);
  }
  if (batch.lit() == batch.hits().count) return;
  InterpolateRadiance(batch);
  batch.clock.Charge(Stage::kShade);
}

// light * share, but 0 for a share of 0 even if the light has overflowed to infinity.
float Attenuated(float light, float share) { return share > 0 ? light * share : 0; }

// Attenuates the radiance of the hits below coats by what each coat transmits, which is 1 minus its
// directional albedo, and adds what the coat itself reflects.
void CoverBelow(const CoatedHits& coats, const Soa3<float>& coat_radiance, Soa3<float>* below) {
  const Soa3<float>& transmitted = coats.surfaces.surface.base;
  for (size_t i = 0; i < coats.surfaces.hits.count; ++i) {
    const size_t j = coats.below[i];
    below->x[j] = Attenuated(below->x[j], transmitted.x[i]) + coat_radiance.x[i];
    below->y[j] = Attenuated(below->y[j], transmitted.y[i]) + coat_radiance.y[i];
    below->z[j] = Attenuated(below->z[j], transmitted.z[i]) + coat_radiance.z[i];
  }
}

void ShadeCoats(const DirectBatch& batch, const SampleNumbers* numbers) {
  const CoatedHits& coats = *batch.surfaces.coats;
  std::unique_ptr<BatchRadiance>& room = batch.room.coat_radiance;
  if (!room) room = std::make_unique<BatchRadiance>();
  ShadeSurfaces({batch.plan, coats.surfaces, batch.room, *room, batch.clock, batch.stats,
                 batch.plan.coat_pairs},
                numbers);
  ReflectedRadiance& total = batch.radiance.total;
  CoverBelow(coats, room->total.diffuse, &total.diffuse);
  CoverBelow(coats, room->total.specular, &total.specular);
  CoverBelow(coats, room->total.sum, &total.sum);
  for (size_t layer = 0; layer < room->per_light.size(); ++layer) {
    CoverBelow(coats, room->per_light[layer], &batch.radiance.per_light[layer]);
  }
  batch.clock.Charge(Stage::kShade);
}

}  // namespace

void ShadeDirect(const DirectBatch& batch, const SampleNumbers* numbers) {
  ShadeSurfaces(batch, numbers);
  if (AnyCoat(batch.surfaces)) ShadeCoats(batch, numbers);
}

void ShadeSky(const DirectPlan& plan, const FilmBatch& film, size_t hits, DirectRoom* room,
              BatchRadiance* radiance) {
  if (!plan.sky || hits == film.count) return;
  MakeCameraRays(plan.camera, film.x.data(), film.y.data(), film.count, &room->sky_rays);
  SkyRadiance(plan.sampled_lights[*plan.sky].light, room->sky_rays.direction, film.count,
              &radiance->sky);
}

}  // namespace nacre
