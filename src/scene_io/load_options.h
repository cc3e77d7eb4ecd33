// SPDX-License-Identifier: Apache-2.0
// scene_io/load_options.h: options for reading scene files and models.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scene/user_brdf.h"

namespace nacre {

// A limit for untrusted files: a hundred bytes can ask for a hundred million spheres. Until it is
// rendered, a sphere takes about 130 bytes and a triangle 150 to 500.
inline constexpr uint64_t kDefaultMaxPrimitives = 20'000'000;

struct LoadOptions {
  // Values to set before anything is read ("--set"), as pairs of JSON pointer and JSON text:
  // {"/image/spp", "64"}. Missing objects on the way are made; elements of arrays must exist.
  std::vector<std::pair<std::string, std::string>> overrides = {};

  // An image of the surroundings that lights the scene instead of its own lights ("--environment").
  // It becomes the light "environment", whose other members overrides may change. As the caller
  // chose the file, it may lie anywhere. Empty: none.
  std::filesystem::path environment = {};

  // The variant of its materials in which a glTF model is shown (KHR_materials_variants,
  // "--variant"). nullopt: the materials that it has without one.
  std::optional<std::string> variant = {};

  // Reflection models implemented by the caller, by the name of the material that they replace.
  UserBrdfs user_brdfs = {};

  // Let the scene refer to files outside its own folder.
  bool allow_paths = false;

  // Files that the caller chose himself; like `environment`, they may lie anywhere.
  std::vector<std::filesystem::path> trusted_files = {};

  // Called with each file that the scene refers to, before it is read, perhaps several times for
  // one file, and also for files that do not exist. Symbolic links in the path are not resolved,
  // because their target may change.
  std::function<void(const std::filesystem::path&)> on_file = {};

  // The number of threads for building large shapes; 0: as many as the machine has.
  int threads = 0;

  // Limit on the number of spheres and triangles that the file expands to, in all shapes and lights
  // together. A sphere with a material of its own, as in grids, counts as 16. nullopt:
  // kDefaultMaxPrimitives, and for a model also no more than its file size explains
  // (scene_budget.h).
  std::optional<uint64_t> max_primitives = {};

  // Called now and then with the fraction of the file that has been read. It may throw to stop
  // reading.
  std::function<void(double)> on_progress = {};

  // Called once for each kind of content of a model file that is not shown as the file specifies.
  std::function<void(const std::string&)> on_warning = {};
};

}  // namespace nacre
