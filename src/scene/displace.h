// SPDX-License-Identifier: Apache-2.0
// scene/displace.h: displacement: moves vertices along their normals by a texture's heights, P' = P
// + h n, and computes the normals of the result, once, when a scene is read.
#pragma once

#include "scene/scene.h"

namespace nacre {

// Returns the sphere as triangles, `segments` of them around and half as many from pole to pole,
// with unit normals and the texture coordinates of a spherical mapping around the +y axis.
// Positions at the seam and at the poles are repeated, because their texture coordinates differ.
Mesh TessellateSphere(const Sphere& sphere, int segments);

struct Displacement {
  TextureId texture;
  double distance = 0.1;  // world units between the heights 0 and 1; below 0: into the surface
  int segments = 256;     // around a sphere
  // Origin and unit of length of mappings other than kUv: a sphere's centre and radius, or the
  // texture's `center` and `size` for meshes.
  Vec3d center{0, 0, 0};
  double size = 1;
};

// Moves every position along its normal by `distance` times the height there, and replaces smooth
// normals by those of the moved surface. Positions that coincide, at a seam of texture coordinates,
// at a pole or at a hard edge, move by the mean of their heights along the mean of their normals,
// so that the surface stays closed. Heights are interpolated, not filtered by mip levels: a mesh
// much coarser than the image skips texels. A mesh without normals gets none. If the texture's
// mapping is kUv, the mesh must have texture coordinates.
void Displace(const Scene& scene, const Displacement& displacement, Mesh* mesh);

}  // namespace nacre
