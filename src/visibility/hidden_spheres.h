// SPDX-License-Identifier: Apache-2.0
// visibility/hidden_spheres.h: spheres that no ray can be the first to meet, nor need be stopped
// by, because another sphere parts them from the eye: 100 000 spheres one inside the other would
// all be candidates of every ray through them, and there is nothing to sort them apart by.
#pragma once

#include "scene/scene.h"
#include "visibility/geometry.h"

namespace nacre {

// Marks TraceGeometry::hidden. Not all that are hidden: those that a few spheres hide, and only if
// they hide an eighth of all. `geometry` has the scene's spheres.
//
// What a sphere hides. With the eye outside and no light in it: every sphere that lies inside,
// since a ray that reaches one of them, from wherever it starts on its way to whichever light, has
// met the hider. With the eye and all lights inside, in scenes of spheres alone: every sphere that
// lies outside or around it, since no ray gets out. In both cases spheres that coincide with it and
// have a higher number, for of equal hits that of the lowest number counts. All by margins far
// larger than the rounding of the hit tests, so that hiding changes no bit.
void MarkHiddenSpheres(const Scene& scene, const Vec3d& camera_position, int threads,
                       TraceGeometry* geometry);

}  // namespace nacre
