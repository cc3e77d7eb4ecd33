// SPDX-License-Identifier: Apache-2.0
// scene/polygon.h: triangulates polygons.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/vec.h"

namespace nacre {

// Newell's normal (Sutherland, Sproull and Schumacker 1974), by the right-hand rule. Its length is
// twice the polygon's area, and it is 0 exactly where there is no area. It is accurate for any
// simple polygon of any size, also far from the origin.
Vec3d NewellNormal(std::span<const Vec3d> corners);

// Cuts a simple polygon of n >= 3 corners, convex or not, into n - 2 triangles of the same
// orientation by clipping ears, and appends their corners' indices to `triangles`. A polygon that
// crosses itself or has no area still gives n - 2 triangles, none of them outside its corners.
void Triangulate(std::span<const Vec3d> corners, std::vector<uint32_t>* triangles);

}  // namespace nacre
