// SPDX-License-Identifier: Apache-2.0
// render/plan_notes.h: notes about materials that show less than expected, or that gain energy.
#pragma once

#include <string>
#include <vector>

#include "render/prepared_materials.h"
#include "scene/scene.h"

namespace nacre {

// Returns, by material of the scene, whether any shape has it, directly or through a split.
// `splits` says whether there are any splits.
std::vector<bool> FindUsedMaterials(const Scene& scene, bool splits);

struct NotedMaterials {
  const Scene& scene;
  const PreparedMaterials& prepared;
  const std::vector<bool>& used;  // FindUsedMaterials
};

// Adds notes on functions of the caller's that have no sampler, and a lobe so narrow that
// `max_samples` cosine-distributed samples of the surroundings do not find it: where all of a
// pixel's samples miss the lobe, adaptive sampling takes the pixel for dark.
void NoteNarrowLobes(const NotedMaterials& of, int max_samples, std::vector<std::string>* notes);

// Adds notes on scenes without any light, on perfect mirrors under punctual lights only, and on
// materials that reflect more light than they receive. `sampled_lights` says whether any light has
// an extent.
void NoteMaterials(const NotedMaterials& of, bool sampled_lights, std::vector<std::string>* notes);

}  // namespace nacre
