// SPDX-License-Identifier: Apache-2.0
// render/direct_batch.h: a batch in the direct integrator, its result and its buffers.
#pragma once

#include <memory>
#include <vector>

#include "render/direct_plan.h"
#include "render/stage_clock.h"
#include "render/stats.h"
#include "render/surfaces.h"
#include "sampling/pair_sampler.h"
#include "shading/light_sampling.h"
#include "shading/shade.h"

namespace nacre {

// The result of an integrator for a batch: radiance by hit, except `sky`.
struct BatchRadiance {
  ReflectedRadiance total;             // of all lights
  std::vector<Soa3<float>> per_light;  // of each light that has a layer of its own
  Soa3<float> sky;                     // by ray, if the plan has a sky: its radiance
};

// Buffers of mapped_horizon.h.
struct MirroredLobe {
  LightBatch light;  // mirrored in the surface; irradiance 0 at hits that reflect none of it
  ReflectedRadiance radiance;
  AlignedArray<float> pdf{kBatchCapacity};
};

// Buffers of sampled_lights.h.
struct SampledRoom {
  UnitPoints points{kBatchCapacity};
  LightDirections directions;
  AlignedArray<float> pdf{kBatchCapacity}, weight{kBatchCapacity};
  AlignedArray<uint8_t> closed_form{kBatchCapacity};  // 1: diffuse reflection in closed form
  ReflectedRadiance unit;                             // of a light of colour 1
};

// Buffers of the direct integrator.
struct DirectRoom {
  LightBatch light;
  ShadeScratch shade;
  std::unique_ptr<MirroredLobe> mirrored;  // made for the first lobe around a mapped normal
  std::unique_ptr<SampledRoom> sampled;    // made where the plan has sampled lights
  Soa3<double> shadow_origin;              // by hit, if the plan offsets shadow origins
  ShadowRayBatch shadow_rays;
  AlignedArray<uint32_t> shadow_hits{kBatchCapacity};
  ReflectedRadiance single;                      // of a single light
  RayBatch sky_rays;                             // through the samples
  std::unique_ptr<BatchRadiance> coat_radiance;  // made for the first hit with a coat
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
  size_t first_pair = 0;  // index in DirectPlan::pairs of the first pair of these surfaces

  const HitBatch& hits() const { return surfaces.hits; }
  const Surface& surface() const { return surfaces.surface; }
  size_t lit() const { return surfaces.lit; }  // how many hits are shaded by lights
};

// Adds hits [begin, end).
void AddSoa(const Soa3<float>& from, size_t begin, size_t end, Soa3<float>* to);

// Adds the radiance of one light to the light's layer.
void AddToLightLayer(const DirectBatch& batch, const ReflectedRadiance& of_light, int layer);
// Adds the radiance of one light to the total.
void AddRadiance(const DirectBatch& batch, const ReflectedRadiance& of_light);

}  // namespace nacre
