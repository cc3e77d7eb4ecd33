// render/shadow_cull.h: which spheres of a small scene can lie in shadow at all, so that the others
// need no shadow rays, and a light that none can hide from needs none whatsoever.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/scene.h"

namespace nacre {

// For each sphere 1 if another may come between it and the light, or if it may hide the light from
// itself; 0 only where that is certain not to be. Empty, which means all of them, where nothing is
// known: in scenes with meshes, with more than kMaxCulledSpheres spheres (pairs are tested), or
// with the camera in a sphere.
inline constexpr size_t kMaxCulledSpheres = 256;
std::vector<uint8_t> FindShadowed(const Scene& scene, const Light& light);

}  // namespace nacre
