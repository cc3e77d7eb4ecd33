// SPDX-License-Identifier: Apache-2.0
// scene_io/scene_json.h: converts materials, and a model's whole scene, to the JSON of scene files.
#pragma once

#include <string>

#include "scene/scene.h"
#include "scene_io/json_text.h"

namespace nacre {

// The material as an object of a scene file, with numbers rounded to six digits: its model, all
// numbers and colours except those without effect (no emission, no tint), and the choices that are
// not the model's default. Maps are left out. The material must not be a split.
Json MaterialJson(const Material& material);

// The same object in one line for people: "phong: color 0.8 0.2 0.2, kd 0.96, shininess 19".
std::string DescribeMaterial(const Json& material);

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
