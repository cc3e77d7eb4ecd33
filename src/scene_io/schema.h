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

// The text of scene_io/scene_schema.json.in, which is the schema without what tables define, with
// placeholders: %MATERIAL_REFERENCES%, %MATERIAL_MODELS%, %LIGHT_REFERENCES%, %LIGHT ...%, and, for
// the keys of cameras, pictures and lights, %KEYS ...% and %REQUIRED ...%.
std::string_view SchemaTemplate();

}  // namespace nacre
