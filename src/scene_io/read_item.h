// SPDX-License-Identifier: Apache-2.0
// scene_io/read_item.h: reads one material or shape of a scene file again where nothing else has
// changed. The scene is then the one that all of the file makes.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "scene/parts.h"
#include "scene/scene.h"
#include "scene_io/read_members.h"
#include "scene_io/read_scene.h"

namespace nacre {

// Makes shape `place` of the file an element of the tree's "shapes", and returns its index there.
// Nothing: there is no such shape.
std::optional<size_t> MovePlainSphereToTree(size_t place, SceneTree* tree, ReadMembers* members);

// Puts all plain spheres there.
void ListShapes(SceneTree* tree, ReadMembers* members);

// The shape that is number `place` of the file's.
std::optional<Json> ShapeAt(size_t place, const SceneTree& tree);

// Reads the material of this name into `scene`, and checks it. Nothing, and the scene is as before,
// if anything is wrong with it, or other items of the scene may have to follow: then all of the
// file must be read, which finds what is wrong. `members`: of the tree before.
std::optional<SceneChange> ReadMaterialAlone(const SceneTree& tree, const std::string& name,
                                             const SceneReading& reading, ReadMembers* members,
                                             Scene* scene);

// Likewise the shape that is number `index` of the tree's "shapes", and `place` of the file's.
std::optional<SceneChange> ReadShapeAlone(const SceneTree& tree, size_t index, size_t place,
                                          const SceneReading& reading, ReadMembers* members,
                                          Scene* scene);

}  // namespace nacre
