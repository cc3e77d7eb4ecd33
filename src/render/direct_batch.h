// SPDX-License-Identifier: Apache-2.0
// render/direct_batch.h: the plan of the direct integrator, and a batch in it, its result and its
// buffers.
#pragma once

#include <memory>
#include <vector>

#include "render/hits_plan.h"
#include "render/lights_plan.h"
#include "render/shadow_plan.h"
#include "render/stats.h"
#include "render/surfaces.h"
#include "sampling/pair_sampler.h"
#include "shading/bsdf.h"
#include "shading/light_sampling.h"

namespace nacre {

// What the integrator of direct light (direct.h) reads: the plans of the lights and of their shadow
// rays, and the shapes that these rays may hit.
struct DirectPlan {
  TracedShapes shapes;
  LightsPlan lights;
  ShadowPlan shadows;
  bool offset_shadow_origins = false;  // PlanShadowOrigins: some do not start at their hits
};

// The result of an integrator for a batch: radiance by hit, except `sky`.
struct BatchRadiance {
  ReflectedRadiance total;             // of all lights
  std::vector<Soa3<float>> per_light;  // of each light that has a layer of its own
  Soa3<float> sky;                     // by ray, if the plan has a sky: its radiance
};

// Buffers of sampled_lights.h.
struct SampledRoom {
  UnitPoints points{kBatchCapacity};
  LightDirections directions;
  AlignedArray<float> diffuse_pdf{kBatchCapacity}, glossy_pdf{kBatchCapacity};  // of the BSDF
  AlignedArray<float> weight{kBatchCapacity};
  AlignedArray<uint8_t> closed_form{kBatchCapacity};  // 1: diffuse reflection in closed form
  Soa3<float> irradiance;                             // LightIrradiance
  ReflectedRadiance unit;                             // of a light of colour 1
};

// Buffers of the direct integrator.
struct DirectRoom {
  LightBatch light;
  BsdfRoom bsdf;
  std::unique_ptr<SampledRoom> sampled;  // made where the plan has sampled lights
  Soa3<double> shadow_origin;            // by hit, if the plan offsets shadow origins
  ShadowRayBatch shadow_rays;
  AlignedArray<uint32_t> shadow_hits{kBatchCapacity};
  ReflectedRadiance single;  // of a single light
  RayBatch sky_rays;         // through the samples
};

// The data that the integrator works on. The functions below read the plan and the surfaces, and
// write the rest.
struct DirectBatch {
  const DirectPlan& plan;
  const Surfaces& surfaces;
  DirectRoom& room;
  BatchRadiance& radiance;
  StageClock& clock;
  RenderStats& stats;

  const HitBatch& hits() const { return surfaces.hits; }
  const Surface& surface() const { return surfaces.surface; }
  size_t lit() const { return surfaces.lit; }  // how many hits are shaded by lights
};

// Sets the irradiance of room.light to 0 at hits of normal-mapped batches where no lobe faces the
// light.
void HideUnreflectedLight(const DirectBatch& batch);

// Adds the radiance of one light to the light's layer.
void AddToLightLayer(const DirectBatch& batch, const ReflectedRadiance& of_light, int layer);
// Adds the radiance of one light to the total.
void AddRadiance(const DirectBatch& batch, const ReflectedRadiance& of_light);

}  // namespace nacre
