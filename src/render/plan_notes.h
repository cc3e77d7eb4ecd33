// SPDX-License-Identifier: Apache-2.0
// render/plan_notes.h: what a picture cannot show, or shows against nature, as its materials are.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"
#include "shading/material.h"

namespace nacre {

// Which of the scene's materials are on a shape, splits resolved.
std::vector<bool> FindUsedMaterials(const Scene& scene);

// Adds to the notes: scenes that nothing lights, perfect mirrors under lights that have no extent,
// and materials that reflect more than they get. `materials`: of the scene, in its order.
void NoteMaterials(const Scene& scene, const std::vector<ShadingMaterial>& materials,
                   bool sampled_lights, std::vector<std::string>* notes);

}  // namespace nacre
