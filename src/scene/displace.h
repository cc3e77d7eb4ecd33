// SPDX-License-Identifier: Apache-2.0
// scene/displace.h: surfaces moved along their normals by a texture's heights, once, when a scene
// is read: P' = P + h n, and the normals of what that makes.
#pragma once

#include "scene/scene.h"

namespace nacre {

// A sphere as triangles: `segments` of them around and half as many from pole to pole, with unit
// normals and texture coordinates as spherical mappings have them, around the +y axis. The seam and
// the poles have positions of their own on both sides.
Mesh TessellateSphere(const Sphere& sphere, int segments);

struct Displacement {
  TextureId texture;
  double distance = 0.1;  // world units between the heights 0 and 1; below 0: into the surface
  int segments = 256;     // of a sphere
  // What mappings other than kUv see: a sphere's centre and radius, or a texture's for meshes.
  Vec3d center{0, 0, 0};
  double size = 1;
};

// Moves every position along its normal by `distance` times the height there, and makes its smooth
// normals those of the moved surface. Positions that coincide, at a seam of texture coordinates, at
// a pole or at a hard edge, move as one, by their mean: the surface stays closed. Heights are
// interpolated, not filtered by mip levels: a mesh much coarser than the image skips texels. A mesh
// without normals stays without. It has texture coordinates if the texture's mapping is kUv.
void Displace(const Scene& scene, const Displacement& displacement, Mesh* mesh);

}  // namespace nacre
