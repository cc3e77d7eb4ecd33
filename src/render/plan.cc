// SPDX-License-Identifier: Apache-2.0
#include "render/plan.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include <fmt/format.h>

#include "base/parallel.h"
#include "base/printable.h"
#include "base/target.h"
#include "render/film_plan.h"
#include "render/frame_window.h"
#include "render/hit_places.h"
#include "render/mesh_points.h"
#include "render/mesh_windows.h"
#include "render/plan_notes.h"
#include "render/rare_features.h"
#include "render/sampled_plan.h"
#include "render/shadow_cull.h"
#include "scene/mesh.h"
#include "visibility/sphere_bins.h"

namespace nacre {
namespace {

Rgb SumAmbient(const Scene& scene) {
  Rgb sum(0, 0, 0);
  for (const Light& light : scene.lights) {
    if (const auto* ambient = std::get_if<AmbientLight>(&light.kind)) sum += ambient->radiance;
  }
  return sum;
}

void PlanLights(const Scene& scene, const RenderSettings& settings, RenderPlan* plan) {
  for (const Layer& layer : plan->layers) {
    if (layer.kind == LayerKind::kLight) ++plan->light_layer_count;
  }
  for (size_t i = 0; i < scene.lights.size(); ++i) {
    const Light& light = scene.lights[i];
    if (!IsPunctual(light)) continue;
    const ShadingLight prepared = PrepareLight(light, scene.camera.position);
    const std::string name = fmt::format("light \"{}\"", light.name);
    if (IsBlack(prepared.color)) {
      plan->items.push_back({name, false, "it is black"});
      continue;
    }
    const bool shadow_rays = scene.image.shadows && light.shadows;
    if (!shadow_rays) {
      plan->items.push_back(
          {name + " shadow rays", false,
           light.shadows ? "the scene turns shadows off" : "the light casts none"});
    }
    PlannedLight& planned = plan->lights.emplace_back();
    planned.index = i;
    planned.light = prepared;
    planned.shadow_rays = shadow_rays;
    planned.layer = LightLayer(plan->layers, i);
    planned.reach = ReachOf(light, scene.camera.position);
  }
  const size_t count = plan->lights.size();
  plan->cull_lights = count >= kFewestCulledLights && !settings.general_path;
  plan->items.push_back(
      {"light culling", plan->cull_lights,
       plan->cull_lights ? fmt::format("of {} lights a tile's hits are given those that they face "
                                       "and whose cone they are in",
                                       count)
       : settings.general_path ? "the general path is asked for"
                               : fmt::format("fewer than {} lights", kFewestCulledLights)});
}

// The cells of adaptive sampling lie on a grid of the frame and are evaluated whole.
Window WholeCells(const Window& window) {
  const auto down = [](int pixel) { return pixel / kCellSize * kCellSize; };
  const auto up = [&](int pixel) { return down(pixel + kCellSize - 1); };
  return {down(window.x0), down(window.y0), up(window.x1), up(window.y1)};
}

void PlanGeometry(const Scene& scene, const RenderSettings& settings, RenderPlan* plan) {
  size_t triangles = 0;
  for (const Mesh& mesh : scene.meshes) {
    plan->mesh_first_triangle.push_back(static_cast<uint32_t>(triangles));
    triangles += mesh.triangles.size() / 3;
  }
  if (scene.spheres.empty() && triangles == 0) {
    plan->items.push_back(
        {"intersector", false, "the scene has no shapes: every pixel is background"});
    return;
  }
  const std::string shapes =
      fmt::format("{} spheres, {} triangles; exact hits in double on {}", scene.spheres.size(),
                  triangles, TargetName(ActiveTarget()));
  plan->eye_outside = EyeIsOutside(scene, settings.threads);
  plan->intersector = std::make_unique<Intersector>(
      scene, scene.camera.position,
      IntersectorSettings{.threads = settings.threads, .embree = false});
  const bool nested = plan->intersector->SpheresAreNested();
  const bool want_tiles =
      settings.intersector != IntersectorChoice::kEmbree && !scene.spheres.empty() && !nested;
  const auto tell = [&](double done) {
    if (settings.on_plan_progress) settings.on_plan_progress(done);
  };
  tell(0.15);
  const double reach = std::max(scene.image.filter.width / 2 - 0.5, 0.0);
  const bool centers = plan->sampler.centered && settings.max_error == 0;
  plan->mesh_windows = FindMeshWindows(scene, plan->camera, reach);
  // Footprints and outlines are looked for in the bins, whoever traces: the bits must not depend on
  // that, nor on the crop, whose bins may fit where the frame's do not.
  if (want_tiles || settings.max_error > 0) {
    const Window frame{0, 0, scene.image.width, scene.image.height};
    const Window binned = settings.max_error > 0 ? WholeCells(frame) : plan->window;
    plan->binned =
        plan->intersector->BinForCamera(plan->camera, binned, centers ? kReachOfCenters : reach);
    plan->tiles = want_tiles && plan->binned;
  }
  plan->items.push_back({"intersector tiles, for camera rays", plan->tiles,
                         plan->tiles  ? "spheres binned to 16x16 pixels need no tree: " + shapes
                         : want_tiles ? "the bins would not fit 256 MiB"
                         : scene.spheres.empty() ? "there are no spheres"
                         : nested                ? kNestedSpheres
                                                 : "--intersector embree"});
  tell(0.4);
  const bool tree_for_punctual = PlanShadows(scene, settings, plan);
  const bool tree_for_sampled = PlanSampledShadows(scene, settings, plan);
  const bool tree_for_shadows = tree_for_punctual || tree_for_sampled;
  tell(0.8);
  const bool triangles_apart = plan->tiles && triangles > 0;
  if (!plan->tiles || tree_for_shadows) plan->intersector->BuildTree();
  if (triangles_apart) plan->intersector->BuildTriangleTree();
  plan->items.push_back({"intersector embree", !plan->tiles || triangles_apart || tree_for_shadows,
                         !plan->tiles ? "for all rays: " + shapes
                         : triangles_apart && tree_for_shadows
                             ? "for camera rays to triangles, and for shadow rays"
                         : triangles_apart  ? "for camera rays to triangles"
                         : tree_for_shadows ? "for shadow rays"
                                            : "nothing is left for it: no tree is built"});
}

void PlanLayers(const Scene& scene, const RenderSettings& settings, RenderPlan* plan) {
  plan->layers = ParseLayers(settings.layers, scene);
  for (const Layer& layer : plan->layers) {
    for (const ChannelSpec& channel : LayerChannels(layer, PixelType::kFloat)) {
      plan->channels.push_back(IsAveraged(layer.kind)             ? ChannelKind::kAveraged
                               : channel.type == PixelType::kUint ? ChannelKind::kId
                                                                  : ChannelKind::kNearest);
    }
  }
  std::string names;
  for (size_t i = 2; i < plan->layers.size(); ++i) {
    names += (names.empty() ? "" : ", ") + plan->layers[i].name;
  }
  plan->items.push_back(
      {"layers", !names.empty(), names.empty() ? "only colour and coverage are asked for" : names});
}

void PlanTextures(const Scene& scene, const RenderSettings& settings, RenderPlan* plan) {
  const std::vector<bool> used = FindUsedMaterials(scene);
  size_t count = 0;
  for (size_t i = 0; i < scene.materials.size(); ++i) {
    if (used[i] && plan->materials[i].textured != nullptr) ++count;
  }
  plan->textured = count > 0;
  if (!plan->textured) {
    plan->items.push_back({"textures", false, "no shape's material has a map"});
    return;
  }
  // Hits take several times as much room with what is looked up for them: half as many stay as
  // near.
  plan->samples_per_round = std::max(plan->samples_per_round / 2, 1);
  // A sample stands for its share of the pixel. Adaptive sampling takes as many as it needs.
  const double samples = settings.max_error > 0 ? 64 : scene.image.spp;
  const double footprint = std::max(1 / std::sqrt(samples), 0.125);
  plan->textures = PrepareTextures(scene, plan->camera, footprint, settings.threads);
  size_t bytes = 0;
  for (const SceneImage& image : scene.images) bytes += image.texels->values.size() * sizeof(float);
  plan->items.push_back(
      {"textures", true,
       fmt::format("maps on {} materials: {} images, {:.1f} MiB with their mip levels; a sample's "
                   "footprint is {:g} pixels wide",
                   count, scene.images.size(), static_cast<double>(bytes) / (1 << 20), footprint)});
}

// What the triangles of meshes ask for, after all else.
void PlanMeshes(const Scene& scene, const RenderSettings& settings, RenderPlan* plan) {
  if (scene.meshes.empty() || plan->intersector == nullptr) return;
  const auto casts = [](const auto& light) { return light.shadow_rays; };
  const bool shadows = std::any_of(plan->lights.begin(), plan->lights.end(), casts) ||
                       std::any_of(plan->sampled_lights.begin(), plan->sampled_lights.end(), casts);
  plan->lift_shadows = shadows && LiftsShadowOrigins(scene);
  plan->items.push_back({"smooth terminator", plan->lift_shadows,
                         plan->lift_shadows
                             ? "shadow rays of smooth normals start on the curved surface"
                         : shadows ? "no mesh has smooth normals and asks for it"
                                   : "there are no shadow rays"});
  ShadeMeshes(settings, plan);
}

}  // namespace

RenderPlan MakePlan(const Scene& given, const RenderSettings& settings) {
  RenderPlan plan;
  plan.with_lights = ShowLights(given);
  const Scene& scene = plan.with_lights ? plan.with_lights->scene : given;
  plan.scene = &scene;
  plan.frame = {0, 0, scene.image.width, scene.image.height};
  plan.window = FrameWindow(plan.frame, settings);
  plan.camera = MakeCameraFrame(scene.camera, scene.image.width, scene.image.height);
  const Vec3d& eye = scene.camera.position;
  plan.camera_reach = std::abs(eye.x) + std::abs(eye.y) + std::abs(eye.z);
  plan.background = scene.background;
  PlanLayers(scene, settings, &plan);
  PlanSampling(scene, settings, &plan);
  PlanLights(scene, settings, &plan);
  PlanSampledLights(scene, settings, &plan);
  PlanParts(scene, settings, &plan);
  PlanGeometry(scene, settings, &plan);
  const Rgb ambient = SumAmbient(scene);
  plan.items.push_back({"ambient light", !IsBlack(ambient),
                        IsBlack(ambient) ? "the scene has none" : "a constant per material"});
  plan.materials.reserve(scene.materials.size());
  for (const Material& material : scene.materials) {
    plan.materials.push_back(PrepareMaterial(material, ambient));
    plan.splits = plan.splits || std::holds_alternative<SplitMaterial>(material.model);
    plan.one_sided = plan.one_sided || material.emits_in_front_only;
    plan.exact_directions = plan.exact_directions || HasDoubleTerms(plan.materials.back());
  }
  PlanPlaces(scene, settings, &plan);
  PlanTextures(scene, settings, &plan);
  PlanLightOffsets(scene, settings, &plan);
  plan.black = {static_cast<uint32_t>(plan.materials.size())};
  plan.materials.emplace_back().model = LambertModel{Rgb(0, 0, 0)};
  if (settings.max_error > 0) {
    plan.adaptive = PlanAdaptive(scene, plan.materials, settings.max_error, settings.max_samples);
    plan.adaptive.brightest = BrightestObject(plan);
    // A texture may hold anything between pixel centres, and triangles are not binned.
    plan.adaptive.footprints = plan.adaptive.footprints && plan.binned && scene.meshes.empty() &&
                               !plan.splits && !plan.textured;
    const PixelFilter& filter = scene.image.filter;
    const bool square = filter.kind == FilterKind::kBox && filter.width <= 1;
    if (square && plan.adaptive.footprints) plan.adaptive.square = filter.width / 2;
    plan.substitutions.push_back(
        {"adaptive sampling", true,
         fmt::format(
             "each block of 4x4 pixels samples until its pixels' 95 % intervals are within {} "
             "of max(|L|, 0.05){}, and there are enough samples to have met what is rare there; "
             "{}{}",
             settings.max_error,
             std::isinf(plan.adaptive.white)
                 ? ""
                 : fmt::format(", and those of highlights of white, {:.3g}", plan.adaptive.white),
             plan.adaptive.footprints ? "those on one smooth hit stop at their pixels' centres"
                                      : "none is known to be smooth",
             plan.adaptive.square > 0 ? "; pixels that one outline crosses weigh their hits by the "
                                        "share that is covered"
                                      : "")});
  }
  PlanMeshes(scene, settings, &plan);
  PlanFilm(scene, settings, &plan);
  PlanPositions(scene, settings, &plan);
  NoteMaterials(scene, &plan);
  return plan;
}

Vec3d FaceNormalOf(const RenderPlan& plan, uint32_t primitive) {
  const TriangleRef triangle = TriangleOf(plan, primitive);
  return FaceNormal(*triangle.mesh, triangle.triangle);
}

uint32_t ObjectOf(const RenderPlan& plan, uint32_t primitive) {
  const auto spheres = static_cast<uint32_t>(plan.scene->spheres.size());
  if (primitive < spheres) return primitive;
  return spheres + static_cast<uint32_t>(TriangleOf(plan, primitive).number);
}

MaterialId MaterialAt(const RenderPlan& plan, uint32_t primitive, double film_x) {
  const Scene& scene = *plan.scene;
  const size_t spheres = scene.spheres.size();
  const MaterialId id = primitive < spheres ? scene.spheres[primitive].material
                                            : TriangleOf(plan, primitive).mesh->material;
  if (!plan.splits) return id;
  const auto* split = std::get_if<SplitMaterial>(&scene.materials[id.index].model);
  if (split == nullptr) return id;
  const double fraction = film_x / plan.frame.width();
  const auto band = std::upper_bound(split->at.begin(), split->at.end(), fraction);
  return split->materials[static_cast<size_t>(band - split->at.begin())];
}

std::string ExplainPlan(const RenderPlan& plan, const RenderStats* stats) {
  std::string text = "plan:\n";
  for (const PlanItem& item : plan.items) {
    text += fmt::format("  {}  {}: {}\n", item.used ? "used   " : "skipped", Printable(item.what),
                        Printable(item.reason));
  }
  // What is skipped above changes no bit; what is not exact stands here.
  text += "substitutions (which agree within a stated error):\n";
  for (const PlanItem& item : plan.substitutions) {
    text += fmt::format("  {}: {}\n", Printable(item.what), Printable(item.reason));
  }
  if (plan.substitutions.empty()) text += "  none: every skip above leaves all bits as they are\n";
  if (stats == nullptr) return text;
  if (plan.cull_lights && stats->light_batches > 0) {
    text += fmt::format(
        "lights culled: {:.1f} % of {} lights times batches of hits\n",
        100 * static_cast<double>(stats->culled_lights) / static_cast<double>(stats->light_batches),
        stats->light_batches);
  }
  double total = 0;
  for (const double seconds : stats->stage_seconds) total += seconds;
  text += "share of the time (all threads):\n";
  for (size_t i = 0; i < kStageCount; ++i) {
    const Stage stage = static_cast<Stage>(i);
    text += fmt::format("  {:<10} {:5.1f} %  {:8.2f} ms\n", StageName(stage),
                        total > 0 ? 100 * stats->seconds(stage) / total : 0.0,
                        1e3 * stats->seconds(stage));
  }
  return text;
}

}  // namespace nacre
