// SPDX-License-Identifier: Apache-2.0
// scene_io/gltf_readers.h: the cameras, lights, materials and meshes of a glTF file, for its nodes.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "base/vec.h"
#include "scene/scene.h"
#include "scene_io/gltf_document.h"
#include "scene_io/scene_budget.h"
#include "scene_io/unique_names.h"

namespace nacre {

// The camera of the file with the index `camera`, placed by the node `index`, whose matrix (row
// vectors) is given. Throws Error (kBadInput) for a camera that does not exist or has no view.
// Returns none, with a warning, where the matrix maps the view direction to zero. Clipping planes
// are ignored: nothing is clipped.
std::optional<Camera> MakeGltfCamera(int camera, size_t index, const Imath::M44d& world_from_node,
                                     GltfDocument* document);

// Adds a light of the file (KHR_lights_punctual) to the scene, placed by the node `index` with this
// matrix (row vectors), under a name that `names` has not returned before. Intensities are taken
// unchanged: lux as irradiance, candela as radiant intensity. A light with a direction that the
// matrix maps to zero is left out, with a warning.
void AddGltfLight(int light, size_t index, const Imath::M44d& world_from_node,
                  GltfDocument* document, UniqueNames* names, Scene* scene);

// Returns a material for each of the file's materials, with the same index and a unique name, and
// after them one more for primitives that name no material. Their textures and images are added to
// the scene.
std::vector<Material> MakeGltfMaterials(GltfDocument* document, Scene* scene);

// Adds the primitives of a mesh that have triangles, in world space. `name` is the node's name.
// `joints` has the matrices of the node's skin (gltf_skins.h), which then place the vertices
// instead of the node's matrix; null if the node has no skin. Throws Error (kBadInput) for
// accessors that do not exist, are too short or of another type, indices out of range, and
// positions that are not finite or out of the range of coordinates.
void AddGltfMesh(int mesh, const std::string& name, const Imath::M44d& world_from_node,
                 const std::vector<Imath::M44d>* joints, GltfDocument* document,
                 SceneBudget* budget, Scene* scene);

}  // namespace nacre
