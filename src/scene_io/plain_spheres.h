// SPDX-License-Identifier: Apache-2.0
// scene_io/plain_spheres.h: plain spheres, which are spheres of a scene file's "shapes" that have a
// centre, a radius and the name of a material, and nothing else. As there may be millions of them,
// they are stored as numbers: as trees of JSON values, they would take 500 bytes each, and most of
// the time that it takes to read the file.
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

// A run of plain spheres that are neighbours in the array "shapes".
struct SphereRun {
  size_t first = 0;             // index of the first one in the array of the file
  std::vector<Sphere> spheres;  // their materials are indices into PlainSpheres::materials
  size_t in_tree = 0;           // number of shapes before it that are in the tree
};

struct PlainSpheres {
  // Ascending, and none is empty. The shape before each run is in the tree.
  std::vector<SphereRun> runs;
  std::vector<std::string> materials;  // names

  const std::string& MaterialOf(const Sphere& sphere) const {
    return materials[sphere.material.index];
  }
};

// Reads plain spheres of a text that a JSON parser also reads. Whatever is not a plain sphere, or
// not JSON, is left to the parser, so that all error messages are the parser's.
class PlainSphereReader {
 public:
  // `*at` points into an array, behind an element. If a comma and a plain sphere follow, returns
  // the sphere and moves `*at` behind it; else returns nullopt.
  std::optional<Sphere> Next(const char** at, const char* end);

  std::vector<std::string> TakeMaterials() { return std::move(materials_); }

 private:
  std::optional<MaterialId> PlaceOf(std::string_view name);

  std::vector<std::string> materials_;
  std::unordered_map<std::string_view, MaterialId> places_;  // by name as written in the text
  std::string_view last_name_;                               // spheres of one material
  MaterialId last_place_;                                    // often come in a row
};

}  // namespace nacre
