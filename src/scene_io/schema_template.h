// SPDX-License-Identifier: Apache-2.0
// scene_io/schema_template.h: the JSON Schema of scene files but for the material models.
#pragma once

#include <string_view>

namespace nacre {

// scene_io/scene_schema.json.in, with the marks %MATERIAL_REFERENCES% and %MATERIAL_MODELS%.
std::string_view SchemaTemplate();

}  // namespace nacre
