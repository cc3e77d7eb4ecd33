// SPDX-License-Identifier: Apache-2.0
// scene_io/schema.h: questions to the schema of scene files (SceneSchema() in load_scene.h).
#pragma once

#include <string>
#include <vector>

namespace nacre {

// The types that a value may have by JSON Schema ("string", "number", "integer", "boolean",
// "array", "object"), each once, in alphabetical order. `tokens`: the names and indices that lead
// to it from the scene's root. Nothing where the format has no value.
std::vector<std::string> SchemaTypesAt(const std::vector<std::string>& tokens);

}  // namespace nacre
