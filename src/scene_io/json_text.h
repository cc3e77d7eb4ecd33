// SPDX-License-Identifier: Apache-2.0
// scene_io/json_text.h: JSON text to a tree, with the strictness that scene files want.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "scene/fault_list.h"
#include "scene_io/plain_spheres.h"

namespace nacre {

// Keeps the order of the file: lights are added up and materials are numbered in it.
using Json = nlohmann::ordered_json;

// Deeper than any scene; a guard for whatever walks the tree recursively.
inline constexpr size_t kMaxJsonDepth = 100;

// What `text` says. Names that an object has twice are added to `faults` by JSON pointer. Throws
// Error (kBadInput) with `file` in its place for text that is not JSON (line and column), UTF-16,
// numbers too large for a double (pointer) and nesting deeper than 100.
// `on_progress`, if any, is passed the share of the text that has been read now and then.
// `spheres`, if any, gets the plain spheres of a scene's "shapes", which the tree then lacks, but
// for the first shape and those behind one that is no plain sphere.
Json ParseJson(std::string_view text, const std::string& file, FaultList* faults,
               const std::function<void(double)>& on_progress = {},
               PlainSpheres* spheres = nullptr);

// The same for a snippet, an option's value; nothing if ParseJson would find fault with it.
std::optional<Json> TryParseJson(std::string_view text);

// The tree as text, on one line or indented. Bytes that are not UTF-8, which names of files and of
// an OBJ file's materials may hold, become U+FFFD.
std::string JsonText(const Json& json, int indent = -1);

// "scenes/grid.json: /materials/gold", of long names in the pointer and of a long pointer the
// beginning; the file alone for the pointer to all of it.
std::string PlaceInFile(const std::string& file, const std::string& pointer);

// Throws Error with all of the faults, each placed in the file, if there are any.
void ThrowFaults(const FaultList& faults, const std::string& file,
                 ExitCode code = ExitCode::kBadInput);

}  // namespace nacre
