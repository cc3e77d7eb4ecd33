// SPDX-License-Identifier: Apache-2.0
// render/shadow_plan.h: decides which shadow rays must be traced, and how their occluders are
// found.
#pragma once

#include <cstdint>
#include <vector>

#include "render/hits_plan.h"
#include "render/lights_plan.h"

namespace nacre {

// The shadow rays to one light.
struct LightShadows {
  bool rays = false;               // some must be traced
  std::vector<uint8_t> shadowed;   // by sphere: 1 if its hits need shadow rays; empty: all do
  uint32_t occluders = kAnyLight;  // ShadowRayBatch::light
  // Of a sampled light: whether to trace rays even from hits that `shadowed` excludes.
  bool trace_all = false;
};

// Whether no point of the primitive can lie in the light's shadow.
inline bool NeverShadowed(const LightShadows& shadows, uint32_t primitive) {
  return !shadows.rays || (primitive < shadows.shadowed.size() && shadows.shadowed[primitive] == 0);
}

struct ShadowPlan {
  std::vector<LightShadows> punctual, sampled;  // by light of the LightsPlan
  bool tree = false;                            // some lights need a BVH
};

// Decides for each light that casts shadows on which spheres it can be occluded, and whether lists,
// bins or a BVH find the occluders. Makes the intersector compute the lists and bins.
ShadowPlan PlanShadows(const Scene& scene, const RenderSettings& settings,
                       const TracedShapes& shapes, const LightsPlan& lights,
                       PreparedScene* prepared, Explanation* why);

}  // namespace nacre
