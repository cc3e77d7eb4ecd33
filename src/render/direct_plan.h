// SPDX-License-Identifier: Apache-2.0
// render/direct_plan.h: what the integrator of direct light (direct.h) reads: the plans of the
// lights and of their shadow rays, and the shapes that these rays may hit.
#pragma once

#include "render/hits_plan.h"
#include "render/lights_plan.h"
#include "render/shadow_plan.h"

namespace nacre {

struct DirectPlan {
  TracedShapes shapes;
  LightsPlan lights;
  ShadowPlan shadows;
  bool offset_shadow_origins = false;  // PlanShadowOrigins: some do not start at their hits
};

}  // namespace nacre
