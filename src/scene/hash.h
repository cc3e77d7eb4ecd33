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

// Hashes that are costly to compute, kept from one call to the next: those of pictures and meshes
// that scenes share, which never change, and those of shapes and materials. The caller forgets
// those of what has changed.
struct KeptHashes {
  struct Entry {
    std::shared_ptr<const void> source;  // owned, so that no other object can get its address
    uint64_t hash;
  };
  std::vector<Entry> shared;  // used by the scene that was hashed last
  // The hashes of materials, of groups of them and of groups of spheres. Those that are set are up
  // to date.
  std::vector<std::optional<uint64_t>> materials, material_groups, sphere_groups;
  std::optional<uint64_t> meshes;  // of all of them

  void ForgetMaterials();
  void ForgetMaterial(size_t material);
  void ForgetShapes();  // also where their number has changed
  void ForgetSphere(size_t sphere);
};

// A hash of all values that determine the picture, which is equal for scenes with equal values. It
// is written into image headers, so that parts of one picture can be recognised. Not cryptographic.
// Names of materials do not count; sample count and image size do. `kept` is read and updated; it
// may be null.
uint64_t HashScene(const Scene& scene, KeptHashes* kept = nullptr);

// A hash of the spheres and meshes only.
uint64_t HashShapes(std::span<const Sphere> spheres, std::span<const Mesh> meshes);
inline uint64_t HashShapes(const Scene& scene) { return HashShapes(scene.spheres, scene.meshes); }

}  // namespace nacre
