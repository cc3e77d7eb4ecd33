// SPDX-License-Identifier: Apache-2.0
// scene_io/materialx_material.h: a material of a MaterialX document in the form of scene files.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "scene_io/json_text.h"

namespace nacre {

struct MaterialXMaterial {
  std::string name;
  Json material;  // its model, and the parameters that differ from the model's defaults
  // The textures that its maps name, as in a scene's "textures". Their files are relative to the
  // folder in which the document was looked for.
  std::vector<std::pair<std::string, Json>> textures;
  std::vector<std::string> notes;  // what is shown otherwise than the document says
};

}  // namespace nacre
