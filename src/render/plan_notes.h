// SPDX-License-Identifier: Apache-2.0
// render/plan_notes.h: what a picture cannot show, or shows against nature, as its materials are.
#pragma once

#include <vector>

#include "render/plan.h"

namespace nacre {

// Which of the scene's materials are on a shape, splits resolved.
std::vector<bool> FindUsedMaterials(const Scene& scene);

// Adds to plan->notes: perfect mirrors under lights that have no extent, and diffuse reflection
// that makes light.
void NoteMaterials(const Scene& scene, RenderPlan* plan);

}  // namespace nacre
