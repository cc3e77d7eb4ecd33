// SPDX-License-Identifier: Apache-2.0
// scene_io/gltf_types.h: checks that the members of a glTF file have the types that they should.
#pragma once

#include <string>

#include "scene_io/json_text.h"

namespace nacre {

// Adds a fault for each member that nacre reads and that violates its type in glTF 2.0 (negative
// offsets, indices that are not whole numbers and arrays of a wrong length included), and for each
// required member that is missing. Whole numbers that are written as 3.0 or 3e0 become integers.
// What is not read (animations, extras, unknown extensions) may be anything.
void CheckGltfTypes(Json* root, FaultList* faults);

}  // namespace nacre
