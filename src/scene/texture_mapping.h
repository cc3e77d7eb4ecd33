// SPDX-License-Identifier: Apache-2.0
// scene/texture_mapping.h: maps points on a shape to the (u, v) of a scene's Texture. Scalar, for
// work done once; the SIMD twin, for hits, is shading/coordinates_kernel.cc.
#pragma once

#include "scene/texture.h"

namespace nacre {

// The unit axes of the texture's mapping. z is the texture's axis. x, where longitudes begin,
// points to -z of the world if the axis is vertical, else to the right as seen with the axis
// towards the viewer; rotate_deg then turns x and y about z.
struct MappingFrame {
  Vec3d x, y, z;
};
MappingFrame FrameOf(const Texture& texture);

// Maps the (u, v) of the mapping, with v up, to those of the texture: multiplies by the rows and
// adds `offset`.
struct UvTransform {
  Vec2d u_row, v_row;
  Vec2d offset;

  Vec2d Apply(const Vec2d& uv) const {
    return {u_row.x * uv.x + u_row.y * uv.y + offset.x, v_row.x * uv.x + v_row.y * uv.y + offset.y};
  }
};
UvTransform TransformOf(const Texture& texture);

// Whether the v that texture/mapping.h gives for the mapping grows downwards.
bool IsUpsideDown(MappingKind mapping);

// The texture's (u, v), not wrapped, at a point of a shape. `point` is relative to a sphere's
// centre, in units of its radius, or relative to texture.center, in units of texture.size, for a
// mesh.
Vec2d MapToTexture(const Texture& texture, const Vec3d& point);

}  // namespace nacre
