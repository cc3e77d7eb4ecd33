// SPDX-License-Identifier: Apache-2.0
#include "render/sampled_plan.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace nacre {
namespace {

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

LightBall BallAround(const SampledLight& light) {
  switch (light.form) {
    case SampledForm::kRectangle:
      return {light.place + (light.edge_x + light.edge_y) / 2,
              (light.edge_x + light.edge_y).length() / 2};
    default:  // of a mesh, the ball around it
      return {light.place, light.radius};
  }
}

// For each sphere 1 if anything can come between it and the light.
std::vector<uint8_t> FindShadowed(const OccluderLists& lists) {
  std::vector<uint8_t> shadowed(lists.end.size());
  for (size_t i = 0; i < shadowed.size(); ++i) shadowed[i] = lists.Begin(i) < lists.end[i] ? 1 : 0;
  return shadowed;
}

// Finds who asks for the light's shadow rays, and why, among few spheres. Which of them can be
// shadowed decides what is reflected in closed form, so all intersectors are told the same.
PlanItem PlanListed(const RenderSettings& settings, RenderPlan* plan, PlannedSampledLight* light) {
  const std::optional<LightBall> ball =
      IsSky(light->light) ? std::nullopt : std::optional(BallAround(light->light));
  light->occluders =
      plan->intersector->FindOccludersOfBall(ball, light->primitives, plan->eye_outside);
  const OccluderLists& lists = plan->intersector->Occluders(light->occluders).lists;
  light->shadowed = FindShadowed(lists);
  light->trace_all = settings.general_path;
  const size_t spheres = light->shadowed.size();
  const auto count = std::count(light->shadowed.begin(), light->shadowed.end(), uint8_t{1});
  PlanItem item{"", true,
                fmt::format("{} of {} spheres can lie in another's shadow", count, spheres)};
  if (count == 0 && !light->trace_all) {
    light->shadow_rays = item.used = false;
    item.reason = spheres == 1 ? "a sphere alone, seen from outside, is convex"
                               : "no sphere is between another and the light";
  }
  if (settings.general_path || settings.intersector == IntersectorChoice::kEmbree ||
      lists.longest > kMaxSampledList) {
    light->occluders = kAnyLight;
  } else if (light->shadow_rays) {
    item.reason += fmt::format(", each by {} others at most: no tree", lists.longest);
  }
  if (static_cast<size_t>(count) == spheres) light->shadowed.clear();
  return item;
}

}  // namespace

std::shared_ptr<const SceneWithLights> ShowLights(const Scene& scene) {
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
  if (std::find(shown.begin(), shown.end(), true) == shown.end()) return nullptr;
  return std::make_shared<SceneWithLights>(AddLightShapes(scene, shown));
}

void PlanSampledLights(const Scene& scene, const RenderSettings& settings, RenderPlan* plan) {
  for (size_t i = 0; i < scene.lights.size(); ++i) {
    const Light& light = scene.lights[i];
    if (IsPunctual(light) || std::holds_alternative<AmbientLight>(light.kind)) continue;
    PlannedSampledLight planned;
    planned.index = i;
    planned.light = PrepareSampledLight(light, scene.camera.position);
    planned.shadow_rays = scene.image.shadows && light.shadows;
    planned.layer = LightLayer(plan->layers, i);
    if (plan->with_lights) planned.primitives = plan->with_lights->primitives[i];
    planned.first_pair = kPairs * plan->sampled_lights.size();
    planned.closed_form = HasIrradiance(planned.light) && settings.closed_forms;
    plan->substitutions.push_back(
        {fmt::format("light \"{}\"", light.name), true,
         planned.closed_form ? "diffuse reflection in closed form where all of the light is seen; "
                               "the rest sampled"
                             : "sampled"});
    plan->sampled_lights.push_back(std::move(planned));
  }
  if (plan->sampled_lights.empty()) return;
  plan->pairs = MakePairSampler(LongestSequence(scene, settings),
                                kPairs * plan->sampled_lights.size(), scene.image.seed);
  for (const PlannedSampledLight& planned : plan->sampled_lights) {
    const auto* sky = std::get_if<EnvironmentLight>(&scene.lights[planned.index].kind);
    if (sky == nullptr || !sky->background) continue;
    plan->sky = IsColored(planned.light) ? &planned.light : nullptr;
    if (plan->sky == nullptr) plan->background = planned.light.color;
  }
}

bool PlanSampledShadows(const Scene& scene, const RenderSettings& settings, RenderPlan* plan) {
  const bool few = scene.spheres.size() <= kMaxListedSpheres && scene.meshes.empty();
  bool tree = false;
  for (PlannedSampledLight& light : plan->sampled_lights) {
    PlanItem item{"", true, "something may lie between a surface and the light"};
    if (!light.shadow_rays) {
      item.used = false;
      item.reason = scene.image.shadows ? "the light casts none" : "the scene turns shadows off";
    } else if (few) {
      item = PlanListed(settings, plan, &light);
    }
    item.what = fmt::format("light \"{}\" shadow rays", scene.lights[light.index].name);
    plan->items.push_back(std::move(item));
    tree = tree || (light.shadow_rays && light.occluders == kAnyLight);
  }
  return tree;
}

}  // namespace nacre
