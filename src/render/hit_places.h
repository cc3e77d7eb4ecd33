// SPDX-License-Identifier: Apache-2.0
// render/hit_places.h: where hits lie, asked for as seldom as can be. A sphere's normal tells it,
// so lights that are not near are found without positions, and then most tiles need none at all.
#pragma once

#include "render/plan.h"

namespace nacre {

// Fills ShadingLight::from_spheres of the plan's lights where that is allowed and pays; the plan
// has its materials. Of the whole scene, not of a tile or a region: the bits of a pixel must not
// depend on what else is rendered.
void PlanLightOffsets(const Scene& scene, const RenderSettings& settings, RenderPlan* plan);

// Decides what reads the hits' positions; the plan has all else.
void PlanPositions(const Scene& scene, const RenderSettings& settings, RenderPlan* plan);

// Whether any hit on the candidates needs its position.
bool NeedsPositions(const RenderPlan& plan, const TileCandidates& candidates);

}  // namespace nacre
