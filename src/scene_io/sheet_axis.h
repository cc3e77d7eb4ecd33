// SPDX-License-Identifier: Apache-2.0
// scene_io/sheet_axis.h: an axis of a sheet of spheres as people type it:
//   roughness=0.1:1:5             five numbers, both ends included
//   shininess=1:1024:6:log        at equal ratios
//   shininess=4,8,16,64           a list
//   base_color=#ff0000,[0.8,0.2,0.1]    colours, sRGB codes or linear; or two ends and a count
//   shadowing=height_correlated,separable    options of a choice
//   material=phong,blinn_phong    whole models, by name or as JSON objects
#pragma once

#include <string>
#include <vector>

#include "scene_io/json_text.h"

namespace nacre {

inline constexpr int kMaxSheetCount = 64;  // spheres along an axis of a sheet

struct SheetAxis {
  enum class Kind : uint8_t {
    kParameter,  // a number or a colour
    kChoice,     // one of several named options
    kMaterial,   // replaces the base material
  };
  Kind kind = Kind::kParameter;
  std::string name;                 // "roughness", "shadowing", "material"
  std::vector<Json> values;         // as in scene files, at least one
  std::vector<std::string> labels;  // one for each value, short enough for a picture
};

// Parses `text`; errors are located at `option` ("--rows"). Throws Error (kUsage) if it is not an
// axis. The kind is set only for materials; CheckSheetAxis finds out the others.
SheetAxis ParseSheetAxis(const std::string& option, const std::string& text);

// Throws Error (kBadInput), located at `option`, if a material, an object as in scene files, has a
// model that does not exist.
void CheckModels(const std::string& option, const std::vector<Json>& materials);

// Determines what the axis varies in each of the materials, which are objects as in scene files.
// Throws Error (kBadInput) if one has no such parameter, or a value is invalid for it.
void CheckSheetAxis(const std::string& option, const std::vector<Json>& materials, SheetAxis* axis);

// Parses a material as people type it: the name of a model, a JSON object, or a MaterialX document
// with or without the name of its material ("x.mtlx#gold"). Throws Error (kUsage; kBadInput for the
// document).
Json ParseMaterialText(const std::string& option, const std::string& text);

// Parses a colour as people type it: "#ff8000" (sRGB codes), "[r,g,b]" or "0.5" (linear). Throws
// Error (kUsage).
Json ParseColorText(const std::string& option, const std::string& text);

// The label of a material in a picture: its "name" (which no scene file has), preset or model.
std::string MaterialLabel(const Json& material);

}  // namespace nacre
