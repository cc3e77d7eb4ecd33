// SPDX-License-Identifier: Apache-2.0
// render/hit_positions.h: decides when hits need their positions and double directions.
#pragma once

#include "render/direct_plan.h"
#include "render/film.h"
#include "render/hits_plan.h"
#include "render/surfaces.h"

namespace nacre {

// The stages that read hits after they are found.
struct HitReaders {
  const SurfacePlan& surfaces;
  const DirectPlan& direct;
  const FilmPlan& film;
};

// Sets which optional arrays hits have: `exact_directions`, `all_positions`, `may_be_shadowed`.
void PlanPositions(const Scene& scene, const RenderSettings& settings, const HitReaders& readers,
                   HitsPlan* plan, Explanation* why);

}  // namespace nacre
