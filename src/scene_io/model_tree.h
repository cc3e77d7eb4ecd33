// SPDX-License-Identifier: Apache-2.0
// scene_io/model_tree.h: a model's scene as the JSON of a scene file.
#pragma once

#include "scene/scene.h"
#include "scene_io/json_text.h"

namespace nacre {

// Converts a light of a kind that models have, or are given, to an object of a scene file; null for
// other kinds.
Json ModelLightJson(const Light& light);

// `put` has the values that overrides have set. Its materials and lights are completed to whole
// ones, and those of the scene that it does not name are added. Maps are left out.
void AddMaterials(const Scene& scene, Json* put);
void AddLights(const Scene& scene, Json* put);

// Completes the materials, lights, camera, image and background of `put`: all of the scene but its
// meshes and maps.
Json ModelTree(const Scene& scene, const ImageSettings& image, Json put);

}  // namespace nacre
