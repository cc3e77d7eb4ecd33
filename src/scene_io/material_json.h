// SPDX-License-Identifier: Apache-2.0
// scene_io/material_json.h: materials back to what scene files say.
#pragma once

#include <string>

#include "scene/material.h"
#include "scene_io/json_text.h"

namespace nacre {

// The material as an object of a scene file, numbers to six digits: its model, every number and
// colour (but those that do nothing: no emission, no tint) and the choices that are not the
// model's default. Maps are left out. Not for a split.
Json MaterialJson(const Material& material);

// The same in one line for people: "phong: color 0.8 0.2 0.2, kd 0.96, shininess 19".
std::string DescribeMaterial(const Json& material);

// The material that an object of a scene file says. Throws Error as LoadSceneText does, with `file`
// in its place.
Material MaterialFromJson(const Json& json, const std::string& file);

}  // namespace nacre
