// SPDX-License-Identifier: Apache-2.0
// cli/given_material.h: materials that the command line gives, as JSON in the form of scene files.
#pragma once

#include <string>

#include "scene/material.h"
#include "scene_io/json_text.h"
#include "scene_io/load_options.h"

namespace nacre {

// Options for reading JSON of the command line: its MaterialX documents may be anywhere, and what
// is shown otherwise than they say is printed.
LoadOptions OptionsForGiven(const Json& json);

// Reads one material. Errors are located at `option`.
Material LoadGivenMaterial(const Json& material, const std::string& option);

}  // namespace nacre
