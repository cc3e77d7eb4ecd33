// SPDX-License-Identifier: Apache-2.0
// scene/hash.h: a fingerprint of a scene.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "scene/scene.h"

namespace nacre {

// What is costly to hash, from one call to the next: pictures and meshes that scenes share, which
// never change; and shapes and materials, if the caller knows that these have not changed.
struct KeptHashes {
  struct Entry {
    std::shared_ptr<const void> source;  // held, so that no other has its address
    uint64_t hash;
  };
  std::vector<Entry> shared;       // those of the scene that was hashed last
  std::optional<uint64_t> shapes;  // HashShapes()
  // Of materials, and of groups of them. What is set is up to date.
  std::vector<std::optional<uint64_t>> materials, material_groups;

  void ForgetMaterials();
  void ForgetMaterial(size_t material);
};

// Equal for scenes that render the same picture because they hold the same values; written into
// image headers, so that parts of one picture know each other. Not cryptographic. Names of
// materials do not count, sample count and image size do.
// `kept` may be null.
uint64_t HashScene(const Scene& scene, KeptHashes* kept = nullptr);

// Likewise of the spheres and meshes alone.
uint64_t HashShapes(std::span<const Sphere> spheres, std::span<const Mesh> meshes);
inline uint64_t HashShapes(const Scene& scene) { return HashShapes(scene.spheres, scene.meshes); }

}  // namespace nacre
