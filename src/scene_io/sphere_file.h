// SPDX-License-Identifier: Apache-2.0
// scene_io/sphere_file.h: spheres from the rows of a file: .csv, .npy and the vertices of a .ply.
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

// What the scene says of the rows.
struct SphereRowSettings {
  std::optional<double> radius;       // of rows that say none
  MaterialId material;                // likewise; invalid: each must say one
  std::vector<MaterialId> materials;  // what numbers in the file are places in
  const std::unordered_map<std::string, MaterialId>* by_name = nullptr;  // the scene's materials
};

// Throws Error (kBadInput) with the file, and its line or row: for what is malformed or incomplete,
// numbers that are out of range, materials that there are not, and more rows than the budget has.
std::vector<Sphere> ReadSphereFile(const std::filesystem::path& path,
                                   const SphereRowSettings& settings, SceneBudget* budget);

}  // namespace nacre
