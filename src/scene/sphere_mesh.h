// SPDX-License-Identifier: Apache-2.0
// scene/sphere_mesh.h: spheres as meshes, to compare interpolations and to put images on. The
// normals are the sphere's own; faces are counter-clockwise from outside.
#pragma once

#include "scene/shapes.h"

namespace nacre {

// An icosahedron whose faces are cut in four `subdivisions` times (0 to 7: 20 to 327 680 faces).
struct Icosphere {
  Vec3d center{0, 0, 0};
  double radius = 1;  // > 0
  int subdivisions = 3;
};
Mesh MakeMesh(const Icosphere& sphere);

// Meridians and parallels, the poles at +y and -y: `segments` (from 3 on) around, `rings` (from 2
// on) from pole to pole. uvs are longitude and latitude: u = 0 and 1 at +x, a seam of repeated
// positions, and grows eastwards (by way of -z); v = 0 at the lower pole.
struct UvSphere {
  Vec3d center{0, 0, 0};
  double radius = 1;  // > 0
  int segments = 48;
  int rings = 24;
};
Mesh MakeMesh(const UvSphere& sphere);

}  // namespace nacre
