// SPDX-License-Identifier: Apache-2.0
// scene_io/schema.h: the schema of scene files, and queries to it.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace nacre {

// The JSON Schema (draft 2020-12) of scene files.
std::string_view SceneSchema();

// The types that JSON Schema allows for a value ("string", "number", "integer", "boolean", "array",
// "object"), each once, in alphabetical order. `tokens` are the names and indices that lead to the
// value from the scene's root. Empty where the format has no value.
std::vector<std::string> SchemaTypesAt(const std::vector<std::string>& tokens);

}  // namespace nacre
