// SPDX-License-Identifier: Apache-2.0
#include "render/lights_plan.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "render/camera.h"
#include "render/surfaces.h"

namespace nacre {
namespace {

// With more spheres many batches hold hits on several of them, and looking up offsets hit by hit
// takes longer than computing with positions.
constexpr size_t kMaxOffsetSpheres = 64;

bool LieOnFewSpheres(const Scene& scene, const TracedShapes& shapes) {
  return scene.meshes.empty() && scene.spheres.size() <= kMaxOffsetSpheres && shapes.eye_outside;
}

std::vector<PlannedPunctualLight> PlanPunctualLights(const Scene& scene,
                                                     const std::vector<Layer>& layers,
                                                     Explanation* why) {
  std::vector<PlannedPunctualLight> lights;
  for (size_t i = 0; i < scene.lights.size(); ++i) {
    const Light& light = scene.lights[i];
    if (!IsPunctual(light)) continue;
    ShadingLight prepared = PrepareLight(light, scene.camera.position);
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
    lights.push_back({i, std::move(prepared), shadow_rays, LightLayer(layers, i)});
  }
  return lights;
}

// Decides which lights are located, on spheres, from the hit's normal alone
// (ShadingLight::from_spheres).
void FindFarLights(const Scene& scene, const RenderSettings& settings, const TracedShapes& shapes,
                   std::vector<PlannedPunctualLight>* lights, Explanation* why) {
  if (!settings.far_lights || !LieOnFewSpheres(scene, shapes)) return;
  for (PlannedPunctualLight& planned : *lights) {
    if (!OffsetFromSpheres(scene.spheres, scene.camera.position, &planned.light)) continue;
    why->substitutions.push_back(
        {fmt::format("light \"{}\"", scene.lights[planned.index].name), true,
         fmt::format("it is {} radii or more from every sphere's centre: its position relative to "
                     "a hit is computed from the hit's normal, to 2e-7 of their distance",
                     kFarRadii)});
  }
}

// Each sampled light has a pair of random numbers for each sampling strategy: the light, the cosine
// and the lobe.
constexpr size_t kPairsPerLight = 3;

// The largest number of samples that a pixel takes of one sequence.
int LongestSequence(const Scene& scene, const RenderSettings& settings) {
  if (!(settings.max_error > 0)) return scene.image.spp;
  constexpr int kMaxSequence = 65536;
  return std::min(settings.max_samples, kMaxSequence);
}

// Whether the camera may see some of the ball: it is not wholly outside one of the four planes that
// bound the picture, widened by the pixel filter. A perspective camera's planes meet in the eye.
bool MayBeInView(const Scene& scene, const LightBall& ball) {
  const CameraFrame frame = MakeCameraFrame(scene.camera, scene.image.width, scene.image.height);
  const bool perspective = frame.projection == Projection::kPerspective;
  const double margin = scene.image.filter.width;
  const Vec3d offset = ball.center - scene.camera.position;
  const double along = offset.dot(frame.forward);
  if (along < -ball.radius) return false;
  const auto beyond = [&](const Vec3d& step, int pixels) {
    const double pixel = step.length();
    const double across = std::abs(offset.dot(step)) / pixel;
    const double half = pixel * (pixels / 2.0 + margin);
    // The signed distance of the centre from the plane.
    const double outside =
        perspective ? (across - along * half) / std::hypot(1.0, half) : across - half;
    return outside > ball.radius + 1e-9 * (offset.length() + half);
  };
  return !beyond(frame.step_x, scene.image.width) && !beyond(frame.step_y, scene.image.height);
}

std::vector<PlannedSampledLight> PlanSampledLights(const Scene& scene,
                                                   const RenderSettings& settings,
                                                   const std::vector<Layer>& layers,
                                                   const SceneWithLights* shown, KeptTables* tables,
                                                   Explanation* why) {
  std::vector<PlannedSampledLight> lights;
  for (size_t i = 0; i < scene.lights.size(); ++i) {
    const Light& light = scene.lights[i];
    if (IsPunctual(light) || std::holds_alternative<AmbientLight>(light.kind)) continue;
    PlannedSampledLight& planned = lights.emplace_back();
    planned.index = i;
    planned.light = PrepareSampledLight(light, scene.camera.position, tables, settings.threads);
    planned.casts_shadows = scene.image.shadows && light.shadows;
    planned.layer = LightLayer(layers, i);
    if (shown != nullptr) planned.primitives = shown->primitives[i];
    planned.first_pair = kPairsPerLight * (lights.size() - 1);
    planned.closed_form = HasIrradiance(planned.light) && settings.closed_forms;
    why->substitutions.push_back(
        {fmt::format("light \"{}\"", light.name), true,
         planned.closed_form ? "diffuse reflection in closed form where the whole light is "
                               "visible; the rest sampled"
                             : "sampled"});
  }
  DropUnused(&tables->skies);
  DropUnused(&tables->mesh_lights);
  return lights;
}

// Decides whether the diffuse and specular components are computed besides their sum.
bool PlanComponents(const Scene& scene, const std::vector<Layer>& layers, Explanation* why) {
  const auto shows_component = [](LayerKind kind) {
    return kind == LayerKind::kDiffuse || kind == LayerKind::kSpecular;
  };
  const char* const reason = std::ranges::any_of(layers, shows_component, &Layer::kind)
                                 ? "layers show them"
                             : std::ranges::any_of(scene.meshes, InterpolatesRadiance)
                                 ? "the radiance of some meshes is interpolated"
                                 : nullptr;
  why->items.push_back({"diffuse and specular components", reason != nullptr,
                        reason != nullptr ? reason : "no layer shows them: their sum is enough"});
  return reason != nullptr;
}

}  // namespace

std::shared_ptr<const SceneWithLights> AddVisibleLights(const Scene& scene,
                                                        PreparedScene* prepared) {
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
  ViewKey key{0, prepared->versions.Of(ScenePart::kShapes), {}};
  if (any) {
    key.parts = prepared->versions.Of(ScenePart::kShapes | ScenePart::kLights);
    key.numbers.assign(shown.begin(), shown.end());
    key.numbers.push_back(static_cast<double>(scene.materials.size()));
  }
  // Tangents do not depend on the camera, so they are kept when it moves.
  const PartVersions meshes = prepared->versions.Of(ScenePart::kShapes);
  if (meshes != prepared->meshes_of_tangents) {
    prepared->tables.tangents.clear();
    prepared->meshes_of_tangents = meshes;
  }
  if (prepared->with_lights.IsUpToDate(key)) {
    const std::shared_ptr<SceneWithLights>& with = prepared->with_lights.value;
    if (with) {
      UpdateAllButShapes(scene, with.get());
      // The scene's materials come before those of lights.
      std::vector<Material>& materials = with->scene.materials;
      const auto changed = prepared->versions.MaterialsSince(prepared->materials_with_lights);
      if (!changed) std::ranges::copy(scene.materials, materials.begin());
      for (const uint32_t i : changed.value_or(std::span<const uint32_t>())) {
        materials[i] = scene.materials[i];
      }
    }
    prepared->materials_with_lights = prepared->versions.materials();
    return with;
  }
  prepared->materials_with_lights = prepared->versions.materials();
  return prepared->with_lights.Get(key, [&]() -> std::shared_ptr<SceneWithLights> {
    ++prepared->shapes_made;
    if (!any) return nullptr;
    return std::make_shared<SceneWithLights>(AddLightShapes(scene, shown));
  });
}

LightBall BoundingBall(const SampledLight& light) {
  const Vec3d diagonal = light.edge_x + light.edge_y;  // of rectangles, whose radius is 0
  return {light.place + diagonal / 2, light.radius + diagonal.length() / 2};
}

LightsPlan PlanLights(const Scene& scene, const RenderSettings& settings,
                      const std::vector<Layer>& layers, const SceneWithLights* shown,
                      const TracedShapes& shapes, KeptTables* tables, Explanation* why) {
  LightsPlan plan;
  plan.punctual = PlanPunctualLights(scene, layers, why);
  plan.sampled = PlanSampledLights(scene, settings, layers, shown, tables, why);
  FindFarLights(scene, settings, shapes, &plan.punctual, why);
  plan.background = scene.background;
  for (size_t i = 0; i < plan.sampled.size(); ++i) {
    const PlannedSampledLight& planned = plan.sampled[i];
    const auto* sky = std::get_if<EnvironmentLight>(&scene.lights[planned.index].kind);
    if (sky == nullptr || !sky->background) continue;
    plan.sky = IsColored(planned.light) ? std::optional(i) : std::nullopt;
    if (!plan.sky) plan.background = planned.light.color;
  }
  if (!plan.sampled.empty()) {
    plan.pairs = MakePairSampler(LongestSequence(scene, settings),
                                 kPairsPerLight * plan.sampled.size(), scene.image.seed);
  }
  plan.light_layer_count =
      static_cast<size_t>(std::ranges::count(layers, LayerKind::kLight, &Layer::kind));
  plan.components = PlanComponents(scene, layers, why);
  plan.diffuse_light_layers = plan.components && settings.diffuse_light_layers;
  return plan;
}

}  // namespace nacre
