// SPDX-License-Identifier: Apache-2.0
// scene_io/gltf_types.h: whether the members of a glTF file have the types that they should.
#pragma once

#include <string>

#include "scene_io/json_text.h"

namespace nacre {

// Adds a fault for each member that glTF 2.0 defines and that has another type there: negative
// offsets, indices that are no whole numbers, arrays of a wrong length. Members that are not read
// here, and what extensions hold, are not looked at.
void CheckGltfTypes(const Json& root, FaultList* faults);

}  // namespace nacre
