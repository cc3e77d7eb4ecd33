// SPDX-License-Identifier: Apache-2.0
// scene_io/sphere_file.h: spheres from the rows of a file: .csv, .npy or the vertices of a .ply.
// Its columns are x, y, z, radius and material, the last two of which may be missing.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "scene/shapes.h"
#include "scene_io/scene_budget.h"

namespace nacre {

// What the scene specifies for the rows.
struct SphereRowSettings {
  std::optional<double> radius;       // for rows without one; nullopt: each must have one
  MaterialId material;                // for rows without one; invalid: each must have one
  std::vector<MaterialId> materials;  // numbers in the file are indices into these
  const std::unordered_map<std::string, MaterialId>* by_name = nullptr;  // the scene's materials
};

// Throws Error (kBadInput), with the file and its line or row, for malformed or incomplete rows,
// numbers that are out of range, materials that do not exist, and more rows than the budget allows.
std::vector<Sphere> ReadSphereFile(const std::filesystem::path& path,
                                   const SphereRowSettings& settings, SceneBudget* budget);

}  // namespace nacre
