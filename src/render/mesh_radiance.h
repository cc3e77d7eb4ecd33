// SPDX-License-Identifier: Apache-2.0
// render/mesh_radiance.h: what the vertices or triangles of meshes reflect, where that is what is
// interpolated (Gouraud 1971) or left as it is (flat). Worked out once in the plan.
#pragma once

#include <array>
#include <vector>

#include "base/vec.h"
#include "render/settings.h"
#include "scene/handle.h"

namespace nacre {

struct RenderPlan;
struct TileScratch;

// Of each vertex of a mesh under Gouraud's interpolation, or of each triangle of a flat one.
struct SideRadiance {
  std::vector<Vec3f> diffuse, specular;
  std::vector<std::vector<Vec3f>> lights;  // of each light that a layer shows alone
};

struct MeshRadiance {
  MaterialId material;  // a split mesh has one of these for each of its materials
  // As the vertices' normals point, and as they do not: triangles may be seen from either side. Of
  // flat meshes the first only: a triangle shows the camera one side.
  std::array<SideRadiance, 2> sides;
};

// Fills plan->mesh_radiance; all else of the plan is there.
void ShadeMeshes(const RenderSettings& settings, RenderPlan* plan);

// Whether a hit on the primitive reflects what its mesh's vertices or triangles do.
bool IsInterpolated(const RenderPlan& plan, uint32_t primitive);

// Fills scratch->total and per_light of its runs of such hits.
void Interpolate(const RenderPlan& plan, TileScratch* scratch);

}  // namespace nacre
