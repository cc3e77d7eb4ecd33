// SPDX-License-Identifier: Apache-2.0
// scene_io/schema_template.h: the JSON Schema of scene files without what tables define.
#pragma once

#include <string_view>

namespace nacre {

// The text of scene_io/scene_schema.json.in, with placeholders: %MATERIAL_REFERENCES%,
// %MATERIAL_MODELS%, and, for the keys of cameras, pictures and lights, %KEYS ...% and %REQUIRED
// ...%.
std::string_view SchemaTemplate();

}  // namespace nacre
