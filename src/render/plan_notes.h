// SPDX-License-Identifier: Apache-2.0
// render/plan_notes.h: notes on what a scene's materials cannot show, or reflect against the laws
// of physics.
#pragma once

#include <string>
#include <vector>

#include "render/prepared_materials.h"
#include "scene/scene.h"

namespace nacre {

// By material of the scene: whether any shape has it, directly or as a part of a split. `splits`:
// whether there are any.
std::vector<bool> FindUsedMaterials(const Scene& scene, bool splits);

struct NotedMaterials {
  const Scene& scene;
  const PreparedMaterials& prepared;
  const std::vector<bool>& used;  // FindUsedMaterials
};

// Adds a note on functions of the caller's that have no sampler and a lobe so narrow that
// `max_samples` of a surrounding, by the cosine law, do not find it: where all of a pixel's samples
// miss it, adaptive sampling takes it for dark.
void NoteNarrowLobes(const NotedMaterials& of, int max_samples, std::vector<std::string>* notes);

// Adds notes on scenes without any light, on perfect mirrors under punctual lights only, and on
// materials that reflect more light than they receive. `sampled_lights`: whether any light has an
// extent.
void NoteMaterials(const NotedMaterials& of, bool sampled_lights, std::vector<std::string>* notes);

}  // namespace nacre
