// SPDX-License-Identifier: Apache-2.0
// render/plan_notes.h: notes on what a scene's materials cannot show, or reflect against the laws
// of physics.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"
#include "shading/material.h"

namespace nacre {

// By material of the scene: whether any shape has it, directly or as a part of a split.
std::vector<bool> FindUsedMaterials(const Scene& scene);

// Adds notes on scenes without any light, on perfect mirrors under punctual lights only, and on
// materials that reflect more light than they receive. `materials`: those of the scene, in its
// order. `sampled_lights`: whether any light has an extent.
void NoteMaterials(const Scene& scene, const std::vector<ShadingMaterial>& materials,
                   bool sampled_lights, std::vector<std::string>* notes);

}  // namespace nacre
