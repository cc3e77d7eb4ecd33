// SPDX-License-Identifier: Apache-2.0
// render/highlights.h: which lights make highlights, and how wide these are: what is alike of those
// on spheres (glints.h) and on meshes (mesh_glints.h).
#pragma once

#include "render/adaptive_plan.h"
#include "render/direct_plan.h"
#include "render/surfaces.h"

namespace nacre {

std::vector<HighlightLight> FindHighlightLights(const Scene& scene, const DirectPlan& direct);

// Half-width, in radians, of a lobe around the half vector; infinite where there is none. That of
// Phong's, which is around the mirrored direction, turns twice as far as the normal.
double HalfVectorWidth(const SurfacePlan& surfaces, const AdaptivePlan& adaptive,
                       uint32_t material);

// Pixels per length at a place relative to the camera, across the view: squared also of areas that
// face the camera plane.
double ScaleAt(const Projector& projector, const Vec3d& place);

struct FilmPlace {
  double x, y;
};
FilmPlace ProjectPoint(const Projector& projector, const Vec3d& place);

}  // namespace nacre
