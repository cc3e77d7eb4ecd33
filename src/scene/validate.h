// SPDX-License-Identifier: Apache-2.0
// scene/validate.h: finds everything that is wrong with a scene, at once. A second check behind the
// reader of scene files, and the first for scenes built in code or by generators.
#pragma once

#include <string>
#include <vector>

#include "base/error.h"
#include "scene/fault_list.h"
#include "scene/parts.h"
#include "scene/scene.h"

namespace nacre {

// Returns the faults of a scene, or nothing if it can be rendered; long lists are cut (FaultList).
// `where` reads like a JSON pointer: camera, image, background, materials and lights by name as in
// scene files ("/materials/gold/roughness"), spheres and meshes by index ("/spheres/3/radius").
// Faults are non-finite numbers and numbers outside scene/limits.h, invalid handles, splits of
// splits, light names that are used twice or cannot name an image layer, cameras without a
// direction, meshes with indices out of range or without any area. A triangle of zero area among
// others is no fault: nothing hits it.
std::vector<Fault> Validate(const Scene& scene);

// Returns the faults of these parts only, for a scene of which the other parts are known to be
// valid.
std::vector<Fault> Validate(const Scene& scene, SceneParts parts);

// Adds the faults of one sphere or mesh, which is at `where`.
void ValidateSphere(const Sphere& sphere, size_t material_count, const std::string& where,
                    FaultList* faults);
void ValidateMesh(const Mesh& mesh, size_t material_count, const std::string& where,
                  FaultList* faults);

// Adds the faults of one of the scene's materials, or those of one of its spheres or meshes with
// the material that it has.
void ValidateMaterial(const Scene& scene, size_t index, FaultList* faults);
void ValidateMaterialOfSphere(const Scene& scene, size_t index, FaultList* faults);
void ValidateMaterialOfMesh(const Scene& scene, size_t index, FaultList* faults);

// Adds the faults of a mesh's positions and indices only.
void ValidateTriangles(const Mesh& mesh, const std::string& where, FaultList* faults);

// True if `name` can be part of a layer's name: 1 to 64 letters, digits, '_', '-' or ' '.
bool IsLayerName(const std::string& name);

}  // namespace nacre
