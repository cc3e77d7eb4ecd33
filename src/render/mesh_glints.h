// SPDX-License-Identifier: Apache-2.0
// render/mesh_glints.h: the position and the size on the film of the highlights that small lights
// cause on meshes, as glints.h finds them on spheres.
#pragma once

#include "render/highlights.h"

namespace nacre {

// Finds the highlights of `causes` on the triangles of all meshes: those whose peak, the
// point where the interpolated normal equals the half vector, lies in the triangle, and whose area
// on the film is less than `max_area` pixels. Only triangles within `margin` pixels of the window
// count. The result is sorted by ascending y. There are no highlights on triangles that extend
// beside or behind the camera, nor on meshes that interpolate radiance instead of normals.
// Occlusion is ignored.
std::vector<Glint> FindMeshGlints(const Scene& scene, const SurfacePlan& surfaces,
                                  const HighlightCauses& causes, const CameraFrame& camera,
                                  const Window& window, double margin, double max_area,
                                  int threads);

}  // namespace nacre
