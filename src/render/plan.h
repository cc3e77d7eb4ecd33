// SPDX-License-Identifier: Apache-2.0
// render/plan.h: what a scene needs, decided once before any ray is traced, and so what is
// skipped. Everything the tiles read is here; `--explain` prints the reasons.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/strip.h"
#include "render/adaptive_plan.h"
#include "render/camera.h"
#include "render/layers.h"
#include "render/light_cull.h"
#include "render/mesh_radiance.h"
#include "render/settings.h"
#include "render/stats.h"
#include "sampling/pair_sampler.h"
#include "sampling/pixel_sampler.h"
#include "scene/light_shapes.h"
#include "scene/scene.h"
#include "shading/sampled_light.h"
#include "shading/shade.h"
#include "shading/textures.h"
#include "visibility/intersector.h"

namespace nacre {

// A decision and its reason. Skipping leaves every bit as the general path would make it.
struct PlanItem {
  std::string what;  // "shadow rays of light key"
  bool used = false;
  std::string reason;  // "one sphere alone cannot shadow itself"
};

// A light that hits are shaded by: not ambient, not black.
struct PlannedLight {
  size_t index;  // into Scene::lights
  ShadingLight light;
  bool shadow_rays;
  int layer;                      // which of the light layers shows it alone, or -1
  std::vector<uint8_t> shadowed;  // per sphere: whether to trace its shadow rays; empty: all
  LightReach reach;
  uint32_t occluders = kAnyLight;  // ShadowRayBatch::light
};

// A light with an extent, or an environment, that is not black.
struct PlannedSampledLight {
  size_t index;  // into Scene::lights
  SampledLight light;
  bool shadow_rays;
  int layer;                       // likewise
  std::vector<uint8_t> shadowed;   // likewise
  uint32_t occluders = kAnyLight;  // likewise
  PrimitiveRange primitives;       // of the light itself, if it is a visible surface
  bool trace_all = false;          // even where nothing can be in the way
  size_t first_pair;               // of the three that RenderPlan::pairs has for it
  bool closed_form;                // its diffuse reflection need not be sampled where all of
                                   // it is seen
};

// Whether no hit on the primitive can lie in the light's shadow.
template <class Planned>
bool NeverShadowed(const Planned& planned, uint32_t primitive) {
  return !planned.shadow_rays ||
         (primitive < planned.shadowed.size() && planned.shadowed[primitive] == 0);
}

struct RenderPlan {
  const Scene* scene = nullptr;
  std::shared_ptr<const SceneWithLights> with_lights;  // owns `scene` where lights are visible
  Window frame;                                        // all pixels: 0, 0, width, height
  Window window;                                       // those to render
  CameraFrame camera;
  double camera_reach = 0;  // sum of its position's coordinates: ShadowRayBatch::end_reach
  PixelSampler sampler;
  AdaptivePlan adaptive;
  std::vector<Layer> layers;          // beauty, alpha, then those asked for
  std::vector<ChannelKind> channels;  // of the layers, in their order
  size_t light_layer_count = 0;
  std::vector<PlannedLight> lights;
  std::vector<PlannedSampledLight> sampled_lights;
  PairSampler pairs;                       // their samples'; three pairs a light
  Rgb background{0, 0, 0};                 // seen where nothing is hit: the scene's or a sky's, or
  const SampledLight* sky = nullptr;       // a sky of many colours, of sampled_lights
  std::vector<ShadingMaterial> materials;  // one per material of the scene, and `black`
  TextureScene textures;                   // empty if no shape has any
  std::vector<std::vector<MeshRadiance>> mesh_radiance;  // per mesh; empty if none has any
  std::vector<uint32_t> mesh_first_triangle;  // running triangle number at which each mesh begins
  std::unique_ptr<Intersector> intersector;   // null: there is nothing to hit
  std::vector<Window> mesh_windows;           // pixels that triangles may be seen in
  bool cull_lights = false;                   // leave out those that cannot reach a batch
  bool binned = false;                        // spheres are binned for the camera
  bool tiles = false;                         // and camera rays find them there, not by Embree
  bool textured = false;                      // some hits may need textures
  bool splits = false;                        // some material depends on the film position
  bool one_sided = false;                     // some material emits in front only
  MaterialId black;                           // the back of those
  bool exact_directions = false;              // some lobe is narrow: hits keep theirs in double
  bool lift_shadows = false;                  // some shadow rays do not start at their hits
  bool eye_outside = false;                   // no camera ray starts in a sphere
  bool all_positions = true;                  // more than shadow rays reads the hits' positions
  std::vector<uint8_t> may_be_shadowed;       // else: which spheres shadow rays may start on
  bool places_unasked = false;                // of samples: shapes alone ask where they lie
  bool one_sample = false;                    // a pixel's only sample is its value: no sums
  // One light is all that hits reflect: the beauty is the sum that its kernel makes of the parts.
  bool one_light = false;
  Leaves leaves = Leaves::kParts;  // what the first light leaves in a hit
  int tile_width = 16;             // pixels; tiles are as high as strips
  int samples_per_round = 1;       // samples of a tile's pixels that make one batch
  std::vector<PlanItem> items;
  std::vector<PlanItem> substitutions;  // choices that agree within a stated error, not to the bit
  std::vector<std::string> notes;       // what the picture cannot show, and why
};

// Columns of a tile: where it spans more cells, less of what it gathers stays in L1.
inline constexpr int kWidestTile = 64;
static_assert(kWidestTile * kStripRows <= static_cast<int>(kBatchCapacity));

// `scene` must be valid (scene/validate.h) and outlive the plan. Throws Error (usage) for a layer
// or region that the scene does not have.
RenderPlan MakePlan(const Scene& scene, const RenderSettings& settings);

// The plan as text: each item, used or skipped, and why; with `stats`, each stage's share.
std::string ExplainPlan(const RenderPlan& plan, const RenderStats* stats);

// The number of the object that a primitive belongs to: that of the sphere, or the number of
// spheres and that of the mesh.
uint32_t ObjectOf(const RenderPlan& plan, uint32_t primitive);

// The unit normal of the triangle of that number.
Vec3d FaceNormalOf(const RenderPlan& plan, uint32_t primitive);

// The material of a primitive where the sample lies at film_x pixels from the frame's left edge:
// splits resolved.
MaterialId MaterialAt(const RenderPlan& plan, uint32_t primitive, double film_x);

}  // namespace nacre
