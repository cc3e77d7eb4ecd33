// SPDX-License-Identifier: Apache-2.0
// scene_io/plain_spheres.h: spheres of a scene file's "shapes" that have a centre, a radius and the
// name of a material, and nothing else. A million of them are kept as numbers: as a tree of JSON
// values each would take 500 bytes, and most of the time that the file takes to read.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "scene/shapes.h"

namespace nacre {

// Neighbours in the array "shapes".
struct SphereRun {
  size_t first = 0;             // the place of the first in the array
  std::vector<Sphere> spheres;  // their materials are places in PlainSpheres::materials
  size_t in_tree = 0;           // how many shapes before it are in the tree
};

struct PlainSpheres {
  // Ascending, none of them empty. Each is preceded by a shape that is in the tree.
  std::vector<SphereRun> runs;
  std::vector<std::string> materials;  // names

  const std::string& MaterialOf(const Sphere& sphere) const {
    return materials[sphere.material.index];
  }
};

// Reads plain spheres of a text that goes on to be read by a JSON parser. What is no plain sphere,
// or no JSON, is left to the parser, whose messages are the only ones.
class PlainSphereReader {
 public:
  // `at` is in an array behind an element. If a comma and a plain sphere follow, they are taken off
  // the text, and `at` is moved behind them.
  std::optional<Sphere> Next(const char** at, const char* end);

  std::vector<std::string> TakeMaterials() { return std::move(materials_); }

 private:
  std::optional<MaterialId> PlaceOf(std::string_view name);

  std::vector<std::string> materials_;
  std::unordered_map<std::string_view, MaterialId> places_;  // by name as the text has it
  std::string_view last_name_;                               // spheres of one material often
  MaterialId last_place_;                                    // come together
};

}  // namespace nacre
