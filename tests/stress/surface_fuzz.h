// SPDX-License-Identifier: Apache-2.0
// tests/stress/surface_fuzz.h: whole renders of what broken models are made of: shading normals
// from anywhere on the sphere, texture coordinates without tangents, tangents of a file that have
// nothing to do with either, normal and bump maps of noise, second coordinates, vertices that are
// half there, lobes of any width down to a mirror's, under lights of every kind. Whatever is in
// them, a picture comes out of them, finite and not negative, and no direction to light is lost.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "scene/scene.h"

namespace nacre {

// A small scene, the same for the same seed everywhere. It is valid (scene/validate.h).
Scene MakeBrokenModel(uint64_t seed);

struct SurfaceFuzzResult {
  uint64_t scenes = 0;
  uint64_t pixels = 0;  // on the models
  uint64_t lit = 0;     // of those, that light reaches
  uint64_t not_finite = 0, negative = 0;
  uint64_t directions_not_finite = 0;
  std::string first_fault;

  bool Holds() const { return not_finite + negative + directions_not_finite == 0 && lit > 0; }
};

// Renders the models of seeds 0 to `scenes` on the active target.
SurfaceFuzzResult FuzzSurfaces(uint64_t scenes, const std::function<void(double)>& on_progress);

// One line.
std::string Describe(const SurfaceFuzzResult& result);

}  // namespace nacre
