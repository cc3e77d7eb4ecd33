// SPDX-License-Identifier: Apache-2.0
// render/mesh_glints.h: where meshes show the highlights of small lights, and how large these are
// on the film: glints.h for triangles.
#pragma once

#include "render/highlights.h"

namespace nacre {

// The highlights of each of adaptive.lights on the triangles of all meshes, as far as they lie
// within `reach` pixels of the window and their areas are less than `largest` pixels: those whose
// peak, where the normal is the half vector, lies in the triangle. In descending order on the film.
// None on triangles that reach beside or behind the camera, and none where radiance, not the
// normal, is interpolated. Shadows and what may hide them are not looked for.
std::vector<Glint> FindMeshGlints(const Scene& scene, const SurfacePlan& surfaces,
                                  const AdaptivePlan& adaptive, const CameraFrame& camera,
                                  const Window& window, double reach, double largest, int threads);

}  // namespace nacre
