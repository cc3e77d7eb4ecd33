// SPDX-License-Identifier: Apache-2.0
// scene/texture_mapping.h: from points on a shape to a texture's (u, v), as a scene's Texture says:
// scalar, for work done once. The SIMD twin, for hits, is shading/coordinates_kernel.cc.
#pragma once

#include "scene/texture.h"

namespace nacre {

// The axes of the texture's mapping, unit: z is its axis, and x points where longitudes begin or,
// seen along an axis that is not vertical, to the right.
struct MappingFrame {
  Vec3d x, y, z;
};
MappingFrame FrameOf(const Texture& texture);

// (u, v) of the texture are these times those of the mapping, v up, plus `offset`.
struct UvTransform {
  Vec2d u_row, v_row;
  Vec2d offset;

  Vec2d Apply(const Vec2d& uv) const {
    return {u_row.x * uv.x + u_row.y * uv.y + offset.x, v_row.x * uv.x + v_row.y * uv.y + offset.y};
  }
};
UvTransform TransformOf(const Texture& texture);

// Whether v grows downwards in what texture/mapping.h gives for the mapping.
bool IsUpsideDown(MappingKind mapping);

// (u, v) at a point of a shape: of a sphere relative to its centre, in units of its radius; of a
// mesh relative to texture.center, in units of texture.size. Not wrapped.
Vec2d MapToTexture(const Texture& texture, const Vec3d& point);

}  // namespace nacre
