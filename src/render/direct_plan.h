// SPDX-License-Identifier: Apache-2.0
// render/direct_plan.h: how direct light is gathered: which lights shine on hits, whether their
// shadow rays need tracing, and by whom.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "render/explanation.h"
#include "render/hits_plan.h"
#include "render/layers.h"
#include "render/light_cull.h"
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
  int layer;                      // which of the light layers shows it alone, or -1
  std::vector<uint8_t> shadowed;  // per sphere: whether to trace its shadow rays; empty: all
  LightReach reach;
  uint32_t occluders = kAnyLight;  // ShadowRayBatch::light
};

// A light with an extent, or an environment.
struct PlannedSampledLight {
  size_t index;  // into Scene::lights
  SampledLight light;
  bool shadow_rays;
  int layer;                       // likewise
  std::vector<uint8_t> shadowed;   // likewise
  uint32_t occluders = kAnyLight;  // likewise
  PrimitiveRange primitives;       // of the light itself, if it is a visible surface
  bool trace_all = false;          // even where nothing can be in the way
  size_t first_pair;               // of the three that DirectPlan::pairs has for it
  bool closed_form;                // its diffuse reflection need not be sampled where all of
                                   // it is seen
};

// Whether no hit on the primitive can lie in the light's shadow.
template <class Planned>
bool NeverShadowed(const Planned& planned, uint32_t primitive) {
  return !planned.shadow_rays ||
         (primitive < planned.shadowed.size() && planned.shadowed[primitive] == 0);
}

// What the vertices of a mesh reflect under Gouraud's interpolation, or the triangles of a flat
// one.
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

struct DirectPlan {
  PrimitiveNumbers primitives;
  CameraFrame camera{};
  std::shared_ptr<const Intersector> intersector;
  std::vector<PlannedPunctualLight> lights;
  std::vector<PlannedSampledLight> sampled_lights;
  PairSampler pairs;          // their samples'; three pairs a light
  size_t coat_pairs = 0;      // the first of those for coats
  std::optional<size_t> sky;  // in sampled_lights: the visible sky, if it varies with direction
  // The constant colour behind the shapes, the scene's or a one-colour sky's; unused with `sky`.
  Rgb background{0, 0, 0};
  size_t light_layer_count = 0;        // lights that a layer shows alone
  bool cull_lights = false;            // leave out those that cannot reach a batch
  bool offset_shadow_origins = false;  // some shadow rays do not start at their hits
  bool eye_outside = false;            // no camera ray starts in a sphere
  double camera_extent = 0;            // ShadowRayBatch::camera_extent
  // One light is all that hits reflect: the beauty is the sum that its kernel makes of the parts.
  bool one_light = false;
  OutputMode output = OutputMode::kOverwrite;            // of the first light of a hit
  std::vector<std::vector<MeshRadiance>> mesh_radiance;  // per mesh; empty if none has any
};

// The scene with the shapes of its visible lights, or null if none of them can be seen or be in the
// way of other light.
std::shared_ptr<const SceneWithLights> ShowLights(const Scene& scene, PreparedScene* prepared);

// Everything but shadows and what the hits' places decide. `shown`: ShowLights' scene, or null.
DirectPlan PlanLights(const Scene& scene, const RenderSettings& settings,
                      const std::vector<Layer>& layers, const SceneWithLights* shown,
                      bool unit_weights, PreparedScene* prepared, Explanation* why);

// Then finds out where far lights are from the normals of hits on spheres.
void PlanLightOffsets(const Scene& scene, const RenderSettings& settings, DirectPlan* plan,
                      Explanation* why);

}  // namespace nacre
