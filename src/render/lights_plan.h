// SPDX-License-Identifier: Apache-2.0
// render/lights_plan.h: by which lights surfaces are shaded, how these are sampled, and which parts
// of the reflected light are kept apart.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "render/explanation.h"
#include "render/hits_plan.h"
#include "render/output_layers.h"
#include "render/prepared_scene.h"
#include "render/settings.h"
#include "sampling/pair_sampler.h"
#include "scene/primitives.h"
#include "scene/scene.h"
#include "scene/scene_with_lights.h"
#include "shading/sampled_light.h"
#include "shading/shade.h"

namespace nacre {

// A directional, point or spot light that is not black.
struct PlannedPunctualLight {
  size_t index;  // into Scene::lights
  ShadingLight light;
  bool casts_shadows;
  int layer;  // the number of its own layer among the light layers, or -1
};

// A light with an extent, or an environment.
struct PlannedSampledLight {
  size_t index;  // into Scene::lights
  SampledLight light;
  bool casts_shadows;
  int layer;                  // as in PlannedPunctualLight
  PrimitiveRange primitives;  // of the light's own shape, if it is visible
  size_t first_pair;          // the first of its three pairs in LightsPlan::pairs
  // Whether its diffuse reflection is computed in closed form at hits from which all of it is
  // visible.
  bool closed_form;
};

struct LightsPlan {
  std::vector<PlannedPunctualLight> punctual;
  std::vector<PlannedSampledLight> sampled;
  PairSampler pairs;          // random points for the sampled lights: three pairs a light
  std::optional<size_t> sky;  // index into `sampled`: a visible sky that is not constant
  // The constant radiance behind the shapes, of the scene or of a constant sky. Unused with `sky`.
  Rgb background{0, 0, 0};
  size_t light_layer_count = 0;       // lights that have a layer of their own
  bool components = false;            // ReflectedRadiance::diffuse and specular are computed
  bool diffuse_light_layers = false;  // RenderSettings::diffuse_light_layers, if `components`
};

// Returns the scene with the shapes of its visible lights added, or null if the camera can see none
// of them and none can occlude other lights.
std::shared_ptr<const SceneWithLights> AddVisibleLights(const Scene& scene,
                                                        PreparedScene* prepared);

// A ball around a light that is no sky, relative to the camera.
LightBall BoundingBall(const SampledLight& light);

// `shown` comes from AddVisibleLights and may be null.
LightsPlan PlanLights(const Scene& scene, const RenderSettings& settings,
                      const std::vector<Layer>& layers, const SceneWithLights* shown,
                      const TracedShapes& shapes, KeptTables* tables, Explanation* why);

}  // namespace nacre
