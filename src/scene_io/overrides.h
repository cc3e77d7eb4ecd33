// SPDX-License-Identifier: Apache-2.0
// scene_io/overrides.h: values put into a scene file's tree before it is read ("--set").
#pragma once

#include <string>

#include "scene_io/json_text.h"

namespace nacre {

// Puts the value that `text` is JSON for where `pointer` points. Objects on the way that are
// missing are made; places in arrays must exist. Throws Error (kUsage) if that cannot be done.
void ApplyOverride(const std::string& pointer, const std::string& text, Json* root);

}  // namespace nacre
