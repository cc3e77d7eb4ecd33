// SPDX-License-Identifier: Apache-2.0
// render/direct_plan.h: how direct light is computed: by which lights, how they are sampled, and
// which of them need shadow rays.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "render/explanation.h"
#include "render/hits_plan.h"
#include "render/layers.h"
#include "render/prepared_scene.h"
#include "render/settings.h"
#include "sampling/pair_sampler.h"
#include "scene/light_shapes.h"
#include "scene/primitives.h"
#include "scene/scene.h"
#include "shading/sampled_light.h"
#include "shading/shade.h"

namespace nacre {

// A directional, point or spot light that is not black.
struct PlannedPunctualLight {
  size_t index;  // into Scene::lights
  ShadingLight light;
  bool shadow_rays;
  int layer;                       // the number of its own layer among the light layers, or -1
  std::vector<uint8_t> shadowed;   // by sphere: 1 if its hits need shadow rays; empty: all do
  uint32_t occluders = kAnyLight;  // ShadowRayBatch::light
};

// A light with an extent, or an environment.
struct PlannedSampledLight {
  size_t index;  // into Scene::lights
  SampledLight light;
  bool shadow_rays;
  int layer;                       // as in PlannedPunctualLight
  std::vector<uint8_t> shadowed;   // as in PlannedPunctualLight
  uint32_t occluders = kAnyLight;  // as in PlannedPunctualLight
  PrimitiveRange primitives;       // of the light's own shape, if it is visible
  bool trace_all = false;          // trace shadow rays even where nothing can occlude them
  size_t first_pair;               // the first of its three pairs in DirectPlan::pairs
  // Whether its diffuse reflection is computed in closed form at hits from which all of it is
  // visible.
  bool closed_form;
};

// Whether no point of the primitive can lie in the light's shadow.
template <class Planned>
bool NeverShadowed(const Planned& planned, uint32_t primitive) {
  return !planned.shadow_rays ||
         (primitive < planned.shadowed.size() && planned.shadowed[primitive] == 0);
}

// The reflected radiance of the vertices of a mesh under Gouraud interpolation, or of the triangles
// of a flat-shaded one.
struct SideRadiance {
  std::vector<Vec3f> diffuse, specular;
  std::vector<std::vector<Vec3f>> lights;  // of each light that has a layer of its own
};

struct MeshRadiance {
  MaterialId material;  // a mesh with a split has a MeshRadiance for each of its materials
  // The radiance of the side that the vertices' normals point to, and of the other side.
  // Flat-shaded meshes use only the first, for the side of each triangle that faces the camera.
  std::array<SideRadiance, 2> sides;
};

struct DirectPlan {
  PrimitiveNumbers primitives;
  CameraFrame camera{};
  std::shared_ptr<const Intersector> intersector;
  std::vector<PlannedPunctualLight> lights;
  std::vector<PlannedSampledLight> sampled_lights;
  PairSampler pairs;          // random points for the sampled lights: three pairs a light
  std::optional<size_t> sky;  // index into sampled_lights: a visible sky that is not constant
  // The constant radiance behind the shapes, of the scene or of a constant sky. Unused with `sky`.
  Rgb background{0, 0, 0};
  size_t light_layer_count = 0;        // lights that have a layer of their own
  bool offset_shadow_origins = false;  // some shadow rays do not start at their hits
  bool eye_outside = false;            // no camera ray starts inside a sphere
  double camera_extent = 0;            // ShadowRayBatch::camera_extent
  bool components = false;             // ReflectedRadiance::diffuse and specular are computed
  bool diffuse_light_layers = false;   // RenderSettings::diffuse_light_layers, if `components`
  std::vector<std::vector<MeshRadiance>> mesh_radiance;  // by mesh; empty if no mesh has any
};

// Returns the scene with the shapes of its visible lights added, or null if the camera can see none
// of them and none can occlude other lights.
std::shared_ptr<const SceneWithLights> AddVisibleLights(const Scene& scene,
                                                        PreparedScene* prepared);

// Plans everything except shadow rays (PlanShadows, shadow_plan.h, which also sets `primitives`,
// `camera`, `intersector` and `eye_outside`), their origins (PlanShadowOrigins), far lights, and
// the radiance that Gouraud meshes reflect (ShadeMeshes). `shown` comes from AddVisibleLights and
// may be null.
DirectPlan PlanLights(const Scene& scene, const RenderSettings& settings,
                      const std::vector<Layer>& layers, const SceneWithLights* shown,
                      PreparedScene* prepared, Explanation* why);

// Afterwards decides which lights are located, on spheres, from the hit's normal alone
// (ShadingLight::from_spheres).
void PlanFarLights(const Scene& scene, const RenderSettings& settings, DirectPlan* plan,
                   Explanation* why);

}  // namespace nacre
