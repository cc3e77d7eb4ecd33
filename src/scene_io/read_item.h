// SPDX-License-Identifier: Apache-2.0
// scene_io/read_item.h: reads a single material or shape of a scene file again when nothing else
// has changed. The resulting scene is the one that reading the whole file gives.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "scene/parts.h"
#include "scene/scene.h"
#include "scene_io/read_members.h"
#include "scene_io/read_scene.h"

namespace nacre {

// If shape number `place` of the file is a plain sphere, moves it into the tree's "shapes". Returns
// the index of the shape there; nullopt: there is no such shape.
std::optional<size_t> MovePlainSphereToTree(size_t place, SceneTree* tree, ReadMembers* members);

// Moves all plain spheres into the tree's "shapes".
void ListShapes(SceneTree* tree, ReadMembers* members);

// Reads the material with this name into `scene`, and validates it. Returns nullopt, and leaves the
// scene unchanged, if anything is wrong with it, or if other items of the scene may depend on the
// change: then the whole file must be read, which reports what is wrong. `members` is what was read
// of the tree before the change.
std::optional<SceneChange> ReadMaterialAlone(const SceneTree& tree, const std::string& name,
                                             const SceneReading& reading, ReadMembers* members,
                                             Scene* scene);

// Like ReadMaterialAlone, for the shape with index `index` in the tree's "shapes" and number
// `place` in the file.
std::optional<SceneChange> ReadShapeAlone(const SceneTree& tree, size_t index, size_t place,
                                          const SceneReading& reading, ReadMembers* members,
                                          Scene* scene);

}  // namespace nacre
