// SPDX-License-Identifier: Apache-2.0
// scene_io/overrides.h: what the caller puts into a scene file's tree before it is read ("--set",
// "--environment").
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scene_io/json_text.h"
#include "scene_io/load_scene.h"
#include "scene_io/text_file.h"

namespace nacre {

// The value that `text` is JSON for. Throws Error (kUsage), which names the pointer, if it is none.
Json ParseValue(const std::string& pointer, const std::string& text);

// Puts the value that `text` is JSON for where `pointer` points. Objects on the way that are
// missing are made; places in arrays must exist. Throws Error (kUsage) if that cannot be done.
void ApplyOverride(const std::string& pointer, const std::string& text, Json* root);

// JSON for a value as people type it behind a pointer: JSON itself, or where the schema of scenes
// wants a string, a word without quotes, which may look like a number if nothing else is wanted.
// `null` stays null. Throws Error (kUsage), which tells what is wanted there, for what is neither.
std::string JsonOfTyped(const std::string& pointer, const std::string& text);

// The names that a pointer is made of, unescaped. Throws Error (kUsage) for what is no pointer.
std::vector<std::string> TokensOf(const std::string& pointer);

// The element of an array of `size` that a pointer's token names; nothing if it names none.
std::optional<size_t> ElementOf(const std::string& token, size_t size);

// The value where these tokens of a pointer lead to; nullptr if there is none.
const Json* FindValue(std::span<const std::string> tokens, const Json& root);

// What an override has replaced.
struct Replaced {
  std::vector<std::string> path;  // names and indices from the root on
  std::optional<Json> value;      // none: there was no such member
};
// The same, and returns what was there.
Replaced ReplaceValue(const std::string& pointer, const std::string& text, Json* root);
// The same by tokens that start at `root`; errors tell the whole pointer.
Replaced ReplaceValue(const std::string& pointer, std::span<const std::string> tokens,
                      const std::string& text, Json* root);
// Puts it back, right after ReplaceValue.
void PutBack(Replaced replaced, Json* root);

// ReplaceValue in the tree of a whole scene file: throws also for an entry that is not there, as
// ApplyOptionsToFile does. The tree is then as before.
// `shape`: where in the tree's "shapes" the one is that the pointer names, if that is elsewhere
// than in the file.
Replaced ReplaceInFile(const std::string& pointer, const std::string& text, Json* root,
                       std::optional<size_t> shape = {});

// Puts the options' environment into the tree in the place of all lights, then their overrides.
// Throws Error: kBadInput for an environment that is no file, kUsage as ApplyOverride does.
void ApplyOptions(const LoadOptions& options, Json* root);

// The same for the tree of a whole scene file, which has all the materials, lights and textures
// that there are. Throws Error (kUsage) also for an override of one that is not there, as a
// mistyped name makes it; a whole new one may be made.
void ApplyOptionsToFile(const LoadOptions& options, Json* root);

// Which files the scene may refer to: those that the options allow, and those that they name.
ReferenceRules RulesOf(const LoadOptions& options);

}  // namespace nacre
