// SPDX-License-Identifier: Apache-2.0
#include "render/direct_plan.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "render/camera.h"
#include "scene/coat.h"

namespace nacre {
namespace {

void PlanPunctualLights(const Scene& scene, const RenderSettings& settings,
                        const std::vector<Layer>& layers, DirectPlan* plan, Explanation* why) {
  for (size_t i = 0; i < scene.lights.size(); ++i) {
    const Light& light = scene.lights[i];
    if (!IsPunctual(light)) continue;
    const ShadingLight prepared = PrepareLight(light, scene.camera.position);
    const std::string name = fmt::format("light \"{}\"", light.name);
    if (IsBlack(prepared.color)) {
      why->items.push_back({name, false, "it is black"});
      continue;
    }
    const bool shadow_rays = scene.image.shadows && light.shadows;
    if (!shadow_rays) {
      why->items.push_back(
          {name + " shadow rays", false,
           light.shadows ? "the scene turns shadows off" : "the light casts none"});
    }
    PlannedPunctualLight& planned = plan->lights.emplace_back();
    planned.index = i;
    planned.light = prepared;
    planned.shadow_rays = shadow_rays;
    planned.layer = LightLayer(layers, i);
    planned.reach = ReachOf(light, scene.camera.position);
  }
  const size_t count = plan->lights.size();
  plan->cull_lights = count >= kFewestCulledLights && !settings.general_path;
  why->items.push_back(
      {"light culling", plan->cull_lights,
       plan->cull_lights ? fmt::format("of {} lights a tile's hits are given those that they face "
                                       "and whose cone they are in",
                                       count)
       : settings.general_path ? "the general path is asked for"
                               : fmt::format("fewer than {} lights", kFewestCulledLights)});
}

// Pairs of points that a light has: on itself, for the diffuse part, and for the lobe.
constexpr size_t kPairs = 3;

// The most samples that one sequence of a pixel has.
int LongestSequence(const Scene& scene, const RenderSettings& settings) {
  if (!(settings.max_error > 0)) return scene.image.spp;
  constexpr int kMost = 65536;
  return std::min(settings.max_samples, kMost);
}

// Whether the camera may see some of the ball: it reaches past the four planes around the picture,
// its pixels' filters included. Those of a perspective camera meet in the eye.
bool MayBeInView(const Scene& scene, const LightBall& ball) {
  const CameraFrame frame = MakeCameraFrame(scene.camera, scene.image.width, scene.image.height);
  const bool perspective = frame.projection == Projection::kPerspective;
  const double reach = scene.image.filter.width;
  const Vec3d offset = ball.center - scene.camera.position;
  const double along = offset.dot(frame.forward);
  if (along < -ball.radius) return false;
  const auto beyond = [&](const Vec3d& step, int pixels) {
    const double pixel = step.length();
    const double across = std::abs(offset.dot(step)) / pixel;
    const double half = pixel * (pixels / 2.0 + reach);
    // The distance of the centre from the plane.
    const double outside =
        perspective ? (across - along * half) / std::hypot(1.0, half) : across - half;
    return outside > ball.radius + 1e-9 * (offset.length() + half);
  };
  return !beyond(frame.step_x, scene.image.width) && !beyond(frame.step_y, scene.image.height);
}

void PlanSampledLights(const Scene& scene, const RenderSettings& settings,
                       const std::vector<Layer>& layers, const SceneWithLights* shown,
                       KeptTables* tables, DirectPlan* plan, Explanation* why) {
  for (size_t i = 0; i < scene.lights.size(); ++i) {
    const Light& light = scene.lights[i];
    if (IsPunctual(light) || std::holds_alternative<AmbientLight>(light.kind)) continue;
    PlannedSampledLight planned;
    planned.index = i;
    planned.light = PrepareSampledLight(light, scene.camera.position, tables);
    planned.shadow_rays = scene.image.shadows && light.shadows;
    planned.layer = LightLayer(layers, i);
    if (shown != nullptr) planned.primitives = shown->primitives[i];
    planned.first_pair = kPairs * plan->sampled_lights.size();
    planned.closed_form = HasIrradiance(planned.light) && settings.closed_forms;
    why->substitutions.push_back(
        {fmt::format("light \"{}\"", light.name), true,
         planned.closed_form ? "diffuse reflection in closed form where all of the light is seen; "
                               "the rest sampled"
                             : "sampled"});
    plan->sampled_lights.push_back(std::move(planned));
  }
  DropUnused(&tables->skies);
  DropUnused(&tables->mesh_lights);
  if (plan->sampled_lights.empty()) return;
  // Coats are surfaces of their own, and their samples independent of those of what is below.
  const bool coats =
      std::any_of(scene.materials.begin(), scene.materials.end(),
                  [](const Material& material) { return CoatOf(material).has_value(); });
  plan->coat_pairs = kPairs * plan->sampled_lights.size();
  plan->pairs = MakePairSampler(LongestSequence(scene, settings),
                                (coats ? 2 : 1) * plan->coat_pairs, scene.image.seed);
  for (size_t i = 0; i < plan->sampled_lights.size(); ++i) {
    const PlannedSampledLight& planned = plan->sampled_lights[i];
    const auto* sky = std::get_if<EnvironmentLight>(&scene.lights[planned.index].kind);
    if (sky == nullptr || !sky->background) continue;
    plan->sky = IsColored(planned.light) ? std::optional(i) : std::nullopt;
    if (!plan->sky) plan->background = planned.light.color;
  }
}

// With one light the parts need not be kept to be added up, unless samples might cancel: what
// rounds a sample's sum may then be more than what is left of the pixel.
void PlanParts(const Scene& scene, const RenderSettings& settings, const std::vector<Layer>& layers,
               bool unit_weights, DirectPlan* plan, Explanation* why) {
  const auto shows_parts = [](const Layer& layer) {
    return layer.kind == LayerKind::kDiffuse || layer.kind == LayerKind::kSpecular ||
           layer.kind == LayerKind::kLight;
  };
  const bool interpolated =
      std::any_of(scene.meshes.begin(), scene.meshes.end(), [](const Mesh& mesh) {
        return mesh.interpolation == Interpolation::kFlat ||
               mesh.interpolation == Interpolation::kGouraud;
      });
  const char* const many = plan->lights.size() != 1 || !plan->sampled_lights.empty()
                               ? "what several lights leave, or none, is added up part by part"
                           : !unit_weights ? "samples have weights"
                           : interpolated  ? "what some meshes reflect is interpolated"
                                           : nullptr;
  plan->one_light = many == nullptr;
  const char* const reason = many != nullptr         ? many
                             : settings.general_path ? "the general path is asked for"
                             : std::any_of(layers.begin(), layers.end(), shows_parts)
                                 ? "layers show them"
                                 : nullptr;
  if (plan->one_light) {
    plan->output = reason == nullptr ? OutputMode::kSum : OutputMode::kComponentsAndSum;
  }
  why->items.push_back(
      {"diffuse and specular parts", reason != nullptr,
       reason != nullptr ? reason : "one light leaves their sum, and no layer asks"});
}

// Of more spheres many batches hold hits on several, whose offsets are gathered hit by hit.
constexpr size_t kMostSpheres = 64;

bool LieOnSpheres(const Scene& scene, const DirectPlan& plan) {
  return scene.meshes.empty() && scene.spheres.size() <= kMostSpheres && plan.eye_outside;
}

}  // namespace

std::shared_ptr<const SceneWithLights> ShowLights(const Scene& scene, PreparedScene* prepared) {
  const auto casts = [](const Light& light) {
    return light.shadows && !std::holds_alternative<AmbientLight>(light.kind);
  };
  const auto casting = std::count_if(scene.lights.begin(), scene.lights.end(), casts);
  std::vector<bool> shown;
  shown.reserve(scene.lights.size());
  for (const Light& light : scene.lights) {
    const std::optional<LightBall> ball = VisibleBall(light);
    const bool blocks_others = scene.image.shadows && casting > (casts(light) ? 1 : 0);
    shown.push_back(ball && (blocks_others || MayBeInView(scene, *ball)));
  }
  const bool any = std::find(shown.begin(), shown.end(), true) != shown.end();
  ShapesKey key{prepared->versions.Of(ScenePart::kShapes), {}, scene.camera.position, 0};
  if (any) {
    key = {prepared->versions.Of(ScenePart::kShapes | ScenePart::kLights), shown,
           scene.camera.position, scene.materials.size()};
  }
  // They lie in the world: a camera that moves does not change them.
  const PartVersions meshes = prepared->versions.Of(ScenePart::kShapes);
  if (meshes != prepared->meshes_of_tangents) {
    prepared->tables.tangents.clear();
    prepared->meshes_of_tangents = meshes;
  }
  if (prepared->with_lights.IsUpToDate(key)) {
    const std::shared_ptr<SceneWithLights>& with = prepared->with_lights.value;
    if (with) UpdateAllButShapes(scene, with.get());
    return with;
  }
  return prepared->with_lights.Get(key, [&]() -> std::shared_ptr<SceneWithLights> {
    ++prepared->shapes_made;
    if (!any) return nullptr;
    return std::make_shared<SceneWithLights>(AddLightShapes(scene, shown));
  });
}

DirectPlan PlanLights(const Scene& scene, const RenderSettings& settings,
                      const std::vector<Layer>& layers, const SceneWithLights* shown,
                      bool unit_weights, PreparedScene* prepared, Explanation* why) {
  DirectPlan plan;
  plan.background = scene.background;
  const Vec3d& eye = scene.camera.position;
  plan.camera_extent = std::abs(eye.x) + std::abs(eye.y) + std::abs(eye.z);
  plan.light_layer_count =
      static_cast<size_t>(std::count_if(layers.begin(), layers.end(), [](const Layer& layer) {
        return layer.kind == LayerKind::kLight;
      }));
  PlanPunctualLights(scene, settings, layers, &plan, why);
  PlanSampledLights(scene, settings, layers, shown, &prepared->tables, &plan, why);
  PlanParts(scene, settings, layers, unit_weights, &plan, why);
  return plan;
}

void PlanLightOffsets(const Scene& scene, const RenderSettings& settings, DirectPlan* plan,
                      Explanation* why) {
  if (!settings.offsets_by_normal || !LieOnSpheres(scene, *plan)) return;
  for (PlannedPunctualLight& planned : plan->lights) {
    if (!OffsetFromSpheres(scene.spheres, scene.camera.position, &planned.light)) continue;
    why->substitutions.push_back(
        {fmt::format("light \"{}\"", scene.lights[planned.index].name), true,
         fmt::format("it is {} radii or more from every sphere's centre: where it lies from a hit "
                     "is found from the hit's normal, to 2e-7 of their distance",
                     kFarRadii)});
  }
}

}  // namespace nacre
