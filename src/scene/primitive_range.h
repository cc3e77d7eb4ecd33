// SPDX-License-Identifier: Apache-2.0
// scene/primitive_range.h: a range of a scene's primitives (scene/primitives.h).
#pragma once

#include <cstdint>

namespace nacre {

// Primitives [begin, end), as Scene numbers them: spheres first, then the meshes' triangles.
struct PrimitiveRange {
  uint32_t begin = 0, end = 0;

  bool Contains(uint32_t primitive) const { return primitive >= begin && primitive < end; }
};

}  // namespace nacre
