// SPDX-License-Identifier: Apache-2.0
// scene_io/gltf_types.h: whether the members of a glTF file have the types that they should.
#pragma once

#include <string>

#include "scene_io/json_text.h"

namespace nacre {

// Adds a fault for each member that is read here and has another type than glTF 2.0 gives it, as
// negative offsets, indices that are not whole numbers or arrays of a wrong length, and for each
// that is missing where it is required. Whole numbers that are written as 3.0 or 3e0 become
// integers. What is not read here (animations, extras, unknown extensions) may be anything.
void CheckGltfTypes(Json* root, FaultList* faults);

}  // namespace nacre
