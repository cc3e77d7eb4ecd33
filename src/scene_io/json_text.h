// SPDX-License-Identifier: Apache-2.0
// scene_io/json_text.h: parses JSON text into a tree, as strictly as scene files require.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "scene/fault_list.h"
#include "scene_io/plain_spheres.h"

namespace nacre {

// Keeps the order of the file: lights are summed and materials are numbered in that order.
using Json = nlohmann::ordered_json;

// Deeper than any scene; it bounds the recursion of functions that walk the tree.
inline constexpr size_t kMaxJsonDepth = 100;

// Parses `text`. Names that occur twice in an object are added to `faults`, located by JSON
// pointer. Throws Error (kBadInput), located in `file`, for text that is not JSON (line and
// column), UTF-16, numbers too large for a double (pointer) and nesting deeper than kMaxJsonDepth.
// `on_progress`, if set, is called now and then with the fraction of the text that has been read.
// `spheres`, if not null, receives the plain spheres of a scene's "shapes", which the tree then
// lacks; the first shape, and the first one after each shape that is no plain sphere, stay in the
// tree.
Json ParseJson(std::string_view text, const std::string& file, FaultList* faults,
               const std::function<void(double)>& on_progress = {},
               PlainSpheres* spheres = nullptr);

// Parses a snippet, such as the value of an option; nullopt if ParseJson would find fault with it.
std::optional<Json> TryParseJson(std::string_view text);

// Serialises the tree, on one line or with `indent` blanks per level. Bytes that are not UTF-8,
// which file names and the material names of an OBJ file may hold, become U+FFFD.
std::string JsonText(const Json& json, int indent = -1);

// Formats a location as "scenes/grid.json: /materials/gold". Long names in the pointer and long
// pointers are shortened. If the pointer is empty (the whole file), the location is the file alone.
std::string PlaceInFile(const std::string& file, const std::string& pointer);

// If there are any faults, throws an Error with all of them, each located in the file.
void ThrowFaults(std::vector<Fault> faults, const std::string& file,
                 ExitCode code = ExitCode::kBadInput);
inline void ThrowFaults(const FaultList& faults, const std::string& file,
                        ExitCode code = ExitCode::kBadInput) {
  ThrowFaults(faults.All(), file, code);
}

}  // namespace nacre
