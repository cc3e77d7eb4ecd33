// SPDX-License-Identifier: Apache-2.0
// scene/hash.h: a fingerprint of a scene.
#pragma once

#include <cstdint>

#include "scene/scene.h"

namespace nacre {

// Equal for scenes that render the same picture because they hold the same values; written into
// image headers, so that parts of one picture know each other. Not cryptographic. Names of
// materials do not count, sample count and image size do.
uint64_t HashScene(const Scene& scene);

// Likewise of the spheres and meshes alone.
uint64_t HashShapes(const Scene& scene);

}  // namespace nacre
