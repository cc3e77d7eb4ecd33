// SPDX-License-Identifier: Apache-2.0
// scene_io/material_json.h: converts materials back to the JSON of scene files.
#pragma once

#include <string>

#include "scene/material.h"
#include "scene_io/json_text.h"

namespace nacre {

// The material as an object of a scene file, with numbers rounded to six digits: its model, all
// numbers and colours except those without effect (no emission, no tint), and the choices that are
// not the model's default. Maps are left out. The material must not be a split.
Json MaterialJson(const Material& material);

// The same object in one line for people: "phong: color 0.8 0.2 0.2, kd 0.96, shininess 19".
std::string DescribeMaterial(const Json& material);

}  // namespace nacre
