// SPDX-License-Identifier: Apache-2.0
// render/highlights.h: finds the lights that cause highlights, and how wide these are, for
// highlights on spheres (glints.h) and on meshes (mesh_glints.h).
#pragma once

#include <limits>
#include <vector>

#include "render/adaptive_plan.h"
#include "render/lights_plan.h"
#include "render/surfaces.h"

namespace nacre {

inline constexpr double kInfiniteDistance = std::numeric_limits<double>::infinity();

// All lights except ambient ones and skies.
std::vector<HighlightLight> FindHighlightLights(const Scene& scene, const LightsPlan& plan);

// The suns of skies that are pictures: their brightest small parts, at most four of each.
std::vector<HighlightLight> FindSuns(const std::vector<PlannedSampledLight>& lights);

// How far the extent of the light, seen from this distance, turns the half vector, in radians.
inline double HalfVectorTurn(const HighlightLight& light, double distance) {
  return (light.directional ? light.radius : light.radius / distance) / 2;
}

// The half-width of the material's narrowest lobe, in radians of the angle between normal and half
// vector; infinite if there is no lobe. A Phong lobe is defined around the mirror direction, which
// turns twice as fast as the normal.
double HalfVectorWidth(const SurfacePlan& surfaces, const HighlightCauses& causes,
                       uint32_t material);

}  // namespace nacre
