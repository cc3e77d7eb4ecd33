// SPDX-License-Identifier: Apache-2.0
// render/direct_batch.h: a batch on its way through the direct integrator, and the buffers for it.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "render/direct_plan.h"
#include "render/stage_clock.h"
#include "render/stats.h"
#include "render/surfaces.h"
#include "sampling/pair_sampler.h"
#include "shading/sampled_light.h"
#include "shading/shade.h"

namespace nacre {

// What an integrator finds for a batch, by hit but for `sky`.
struct BatchRadiance {
  ReflectedRadiance total;             // of all lights
  std::vector<Soa3<float>> per_light;  // of each light that a layer shows alone
  Soa3<float> sky;                     // by ray: what those that hit nothing see of the plan's sky
};

// Buffers of mapped_horizon.h.
struct MirroredLobe {
  LightBatch light;  // the light mirrored in the surface; at hits that reflect nothing of it of
                     // irradiance 0
  ReflectedRadiance radiance;
  AlignedArray<float> pdf{kBatchCapacity};
};

// Buffers of sampled_lights.h.
struct SampledRoom {
  UnitPoints points{kBatchCapacity};
  LightDirections directions;
  AlignedArray<float> pdf{kBatchCapacity}, weight{kBatchCapacity};
  AlignedArray<uint8_t> flat{kBatchCapacity};  // 1: a hit's diffuse part is in closed form
  ReflectedRadiance unit;                      // of a light of colour 1
};

// Buffers of the direct integrator.
struct DirectRoom {
  LightBatch light;
  ShadeScratch shade;
  std::unique_ptr<MirroredLobe> mirrored;  // made for the first lobe about a mapped normal
  std::vector<LightOnBatch> together;      // lights shaded by in one go
  std::unique_ptr<SampledRoom> sampled;    // made where the plan has sampled lights
  Soa3<double> shadow_origin;              // of the hits, where the plan offsets some
  ShadowRayBatch shadow_rays;
  AlignedArray<uint32_t> shadow_hits{kBatchCapacity};
  ReflectedRadiance single;                 // of one light
  RayBatch sky_rays;                        // through the samples
  std::unique_ptr<BatchRadiance> of_coats;  // made for the first hit with a coat
};

// A batch on its way through the integrator.
struct DirectBatch {
  const DirectPlan& plan;
  const Surfaces& surfaces;
  DirectRoom& room;
  BatchRadiance& radiance;
  StageClock& clock;
  RenderStats& stats;
  size_t first_pair = 0;  // DirectPlan::pairs before those of these surfaces

  const HitBatch& hits() const { return surfaces.hits; }
  const Surface& surface() const { return surfaces.surface; }
  size_t lit() const { return surfaces.lit; }  // how many hits lights shine on
};

// ShowLight adds what one light leaves to its layer. AddLight adds it to the total, and to its
// layer unless that is -1.
void ShowLight(const DirectBatch& batch, const ReflectedRadiance& of_light, int layer);
void AddLight(const DirectBatch& batch, const ReflectedRadiance& of_light, int layer);

}  // namespace nacre
