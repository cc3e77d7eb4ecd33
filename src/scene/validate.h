// SPDX-License-Identifier: Apache-2.0
// scene/validate.h: everything that is wrong with a scene, at once. The second line behind the
// reader of scene files, and the first for scenes built in code or by generators.
#pragma once

#include <string>
#include <vector>

#include "base/error.h"
#include "scene/fault_list.h"
#include "scene/parts.h"
#include "scene/scene.h"

namespace nacre {

// The faults of a scene, empty when it can be rendered; long lists are cut (FaultList). `where`
// reads like a JSON pointer: camera, image, background, materials and lights by name as in scene
// files ("/materials/gold/roughness"), spheres and meshes by index ("/spheres/3/radius").
// Non-finite numbers and numbers outside scene/limits.h, handles that lead nowhere, splits of
// splits, light names that are used twice or cannot name an image layer, cameras without a
// direction, meshes with indices out of range or without any area. A triangle of zero area among
// others is no fault: nothing hits it.
std::vector<Fault> Validate(const Scene& scene);

// Those of these parts, the others being without any: what is wrong with a scene of which only they
// have changed.
std::vector<Fault> Validate(const Scene& scene, SceneParts parts);

// The faults of one sphere or mesh; `where` is their place.
void ValidateSphere(const Sphere& sphere, size_t material_count, const std::string& where,
                    FaultList* faults);
void ValidateMesh(const Mesh& mesh, size_t material_count, const std::string& where,
                  FaultList* faults);

// The faults of one of the scene's materials; and what is wrong between one of its spheres or
// meshes and the material that it has.
void ValidateMaterial(const Scene& scene, size_t index, FaultList* faults);
void ValidateMaterialOfSphere(const Scene& scene, size_t index, FaultList* faults);
void ValidateMaterialOfMesh(const Scene& scene, size_t index, FaultList* faults);

// Those of a mesh's positions and indices alone.
void ValidateTriangles(const Mesh& mesh, const std::string& where, FaultList* faults);

// True if `name` can stand in a layer's name: 1 to 64 of letters, digits, '_', '-' and ' '.
bool IsLayerName(const std::string& name);

}  // namespace nacre
