// SPDX-License-Identifier: Apache-2.0
// scene_io/model_tree.h: what a model's scene says, as a scene file has it.
#pragma once

#include "scene/scene.h"
#include "scene_io/json_text.h"

namespace nacre {

// A light that models have, or are given, as an object of a scene file; null for others.
Json ModelLightJson(const Light& light);

// The camera with every member.
Json CameraJson(const Camera& camera);

// `put` has the values that were put: its materials and lights become whole, and those of the
// scene that it does not name are added. Maps are left out.
void AddMaterials(const Scene& scene, Json* put);
void AddLights(const Scene& scene, Json* put);

// The same with camera, image and background: all of the scene but its meshes and maps.
Json ModelTree(const Scene& scene, const ImageSettings& image, Json put);

}  // namespace nacre
