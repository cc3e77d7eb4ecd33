// SPDX-License-Identifier: Apache-2.0
// scene_io/overrides.h: changes that the caller makes to a scene file's tree before it is read
// ("--set", "--environment").
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scene_io/json_text.h"
#include "scene_io/load_options.h"
#include "scene_io/text_file.h"

namespace nacre {

// Parses the JSON value `text`. Throws Error (kUsage), which names the pointer, if it is not JSON.
Json ParseValue(const std::string& pointer, const std::string& text);

// Converts a value as people type it after a pointer to JSON. It may be JSON itself, or, where the
// schema of scenes allows a string, a word without quotes, which may look like a number if the
// schema allows no number there. `null` stays null. Throws Error (kUsage), which tells what is
// expected there, for anything else.
std::string JsonOfTyped(const std::string& pointer, const std::string& text);

// Splits a pointer into its names, unescaped. Throws Error (kUsage) if it is not a JSON pointer.
std::vector<std::string> TokensOf(const std::string& pointer);

// The index that a pointer's token denotes in an array of `size` elements; nullopt if it denotes
// none.
std::optional<size_t> ElementOf(const std::string& token, size_t size);

// The value that the tokens of a pointer lead to from `root`; nullptr if there is none.
const Json* FindValue(std::span<const std::string> tokens, const Json& root);

// What an override has replaced, for PutBack.
struct Replaced {
  std::vector<std::string> path;  // names and indices from the root to the value
  std::optional<Json> value;      // nullopt: there was no such member
};
// Sets the value at `pointer` to the JSON value `text`, and returns what was there. Missing objects
// on the way are made; elements of arrays must exist. Throws Error (kUsage) if that cannot be done.
Replaced ReplaceValue(const std::string& pointer, const std::string& text, Json* root);
// The tokens start at `root`; errors show `pointer`, which may begin further out.
Replaced ReplaceValue(const std::string& pointer, std::span<const std::string> tokens,
                      const std::string& text, Json* root);
// Undoes a ReplaceValue. Nothing else may have changed the tree since.
void PutBack(Replaced replaced, Json* root);

// ReplaceValue in the tree of a whole scene file. Like ApplyOptionsToFile, it also throws for an
// entry that does not exist, and then leaves the tree unchanged. `shape`: the index in the tree's
// "shapes" of the shape that the pointer names, if it differs from the index in the file.
Replaced ReplaceInFile(const std::string& pointer, const std::string& text, Json* root,
                       std::optional<size_t> shape = {});

// Replaces all lights of the tree by the options' environment, if there is one, then applies their
// overrides. Throws Error: kBadInput if the environment is not a file, kUsage as ReplaceValue
// does.
void ApplyOptions(const LoadOptions& options, Json* root);

// Throws Error (kUsage) if the options name a variant: scene files, OBJ and PLY models have none.
void RefuseVariant(const LoadOptions& options);

// ApplyOptions for the tree of a whole scene file, which has all the materials, lights and textures
// that exist. Also throws Error (kUsage) for an override of one that does not exist, as when its
// name is mistyped; an override may make a complete new one. So does a variant.
void ApplyOptionsToFile(const LoadOptions& options, Json* root);

// Which files the scene may refer to: those that the options permit, and those that they name.
ReferenceRules RulesOf(const LoadOptions& options);

}  // namespace nacre
