// SPDX-License-Identifier: Apache-2.0
#include "cli/given_material.h"

#include "cli/print.h"
#include "scene_io/load_scene.h"
#include "scene_io/materialx.h"

namespace nacre {

LoadOptions OptionsForGiven(const Json& json) {
  LoadOptions options;
  options.trusted_files = MaterialXFilesIn(json);
  options.on_warning = [](const std::string& text) { PrintError("warning: {}\n", text); };
  return options;
}

Material LoadGivenMaterial(const Json& material, const std::string& option) {
  return LoadMaterialText(JsonText(material), option, OptionsForGiven(material));
}

}  // namespace nacre
