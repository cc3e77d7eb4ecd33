// SPDX-License-Identifier: Apache-2.0
#include "render/frame_plan.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "base/printable.h"
#include "render/brightest_object.h"
#include "render/camera.h"
#include "render/frame_window.h"
#include "render/hit_positions.h"
#include "render/mesh_glints.h"
#include "render/mesh_shading.h"
#include "render/plan_notes.h"
#include "render/shadow_origins.h"
#include "render/shadow_plan.h"
#include "render/texel_maps.h"

namespace nacre {
namespace {

Rgb SumAmbient(const Scene& scene) {
  Rgb sum(0, 0, 0);
  for (const Light& light : scene.lights) {
    if (const auto* ambient = std::get_if<AmbientLight>(&light.kind)) sum += ambient->radiance;
  }
  return sum;
}

// Why pixels that lie outside the outlines of all spheres are sampled nevertheless; null if they
// are not. (Tiles in which triangles may be visible always sample all pixels.)
const char* WhyEveryPixel(const FramePlan& plan, const RenderSettings& settings) {
  return settings.max_error > 0       ? "adaptive sampling makes its own samples"
         : !plan.hits.trace_by_bins   ? "which pixels these are is not known without bins"
         : plan.direct.sky            ? "they see the sky"
         : plan.scene->image.spp == 1 ? "the only sample of a pixel is at its centre"
         : ShowsNearest(plan.film)    ? "some layers show the hit nearest to the pixel's centre"
         : settings.general_path      ? "the general path is asked for"
                                      : nullptr;
}

void PlanShadowOrigins(const Scene& scene, DirectPlan* plan, Explanation* why) {
  const auto casts = [](const auto& light) { return light.shadow_rays; };
  const bool shadows = std::any_of(plan->lights.begin(), plan->lights.end(), casts) ||
                       std::any_of(plan->sampled_lights.begin(), plan->sampled_lights.end(), casts);
  plan->offset_shadow_origins = shadows && OffsetsShadowOrigins(scene);
  why->items.push_back({"smooth terminator", plan->offset_shadow_origins,
                        plan->offset_shadow_origins
                            ? "shadow rays of smooth normals start on the curved surface"
                        : shadows ? "no mesh has smooth normals and asks for it"
                                  : "there are no shadow rays"});
}

AdaptivePlan PlanAdaptiveSampling(const FramePlan& plan, const RenderSettings& settings,
                                  Explanation* why) {
  const Scene& scene = *plan.scene;
  AdaptivePlan adaptive =
      PlanAdaptiveLevels(scene, plan.surfaces.materials, settings.max_error, settings.max_samples);
  adaptive.brightest = BrightestObject(scene, plan.direct, adaptive.white);
  // Between pixel centres a texture may show anything, and so may a function of the caller's, which
  // may have edges of its own, as a toon shader has, and highlights of any width. Triangles are not
  // binned, so their edges are not known.
  adaptive.footprints = adaptive.footprints && plan.hits.binned && scene.meshes.empty() &&
                        !plan.surfaces.splits && !plan.surfaces.textured &&
                        !Has(plan.surfaces.prepared->any, MaterialTrait::kUserModel);
  adaptive.texel_maps = FindTexelMaps(scene, plan.direct, settings.max_error);
  adaptive.lights = FindHighlightLights(scene, plan.direct);
  adaptive.mesh_glints = FindMeshGlints(scene, plan.surfaces, adaptive, plan.camera, plan.window,
                                        kCellSize + adaptive.filter_radius + kMaxRareWidth,
                                        kMaxRareWidth * kMaxRareWidth, settings.threads);
  // The bins extend one pixel beyond the cell, because the pixels around a triangle tell whether it
  // is part of an edge or a rare feature.
  if (!scene.meshes.empty()) {
    adaptive.small_triangles =
        BinSmallTriangles(plan.surfaces.primitives, MakeProjector(plan.camera), plan.window,
                          adaptive.filter_radius + 1, settings.threads);
  }
  const PixelFilter& filter = scene.image.filter;
  const bool is_box = filter.kind == FilterKind::kBox && filter.width <= 1;
  if (is_box && adaptive.footprints) adaptive.box_half_side = filter.width / 2;
  if (filter.kind == FilterKind::kBox && plan.hits.binned && !plan.direct.sky) {
    adaptive.dust_half_side = filter.width / 2;
  }
  why->substitutions.push_back(
      {"adaptive sampling", true,
       fmt::format(
           "each block of 4x4 pixels samples until its pixels' 95 % intervals are within {} "
           "of max(|L|, 0.05){}, and there are enough samples to find what is rare there; "
           "{}{}{}",
           settings.max_error,
           std::isinf(adaptive.white)
               ? ""
               : fmt::format(", and those of highlights of white, {:.3g}", adaptive.white),
           adaptive.footprints ? "blocks on one smooth surface stop at their pixels' centres"
                               : "no block is known to be smooth",
           adaptive.box_half_side > 0 ? "; pixels that one outline crosses weight their hits by "
                                        "their coverage"
                                      : "",
           adaptive.dust_half_side > 0 ? "; where small shapes alone are before the background, "
                                         "samples lie on them"
                                       : "")});
  return adaptive;
}

// Lights that are shown have materials of their own, which are made with their shapes.
PartVersions VersionsOfLights(const FramePlan& plan, const PreparedScene& prepared) {
  return prepared.versions.Of(plan.with_lights ? SceneParts(ScenePart::kLights) : SceneParts());
}

std::shared_ptr<const PreparedMaterials> MaterialsOf(const FramePlan& plan, bool in_ambient,
                                                     int threads, PreparedScene* prepared) {
  const Scene& scene = *plan.scene;
  const MaterialsKey key{plan.with_lights ? prepared->shapes_made : 0,
                         VersionsOfLights(plan, *prepared), in_ambient, scene.materials.data(),
                         scene.materials.size()};
  auto& kept = prepared->materials;
  const auto changed = prepared->versions.MaterialsSince(prepared->materials_prepared);
  if (!changed) kept.Forget();
  if (kept.IsUpToDate(key)) {
    if (!changed->empty()) PrepareMaterials(scene, in_ambient, *changed, kept.value.get());
  } else {
    kept.Get(key, [&] {
      const auto made = kept.value ? kept.value : std::make_shared<PreparedMaterials>();
      PrepareMaterials(scene, in_ambient, threads, made.get());
      return made;
    });
  }
  prepared->materials_prepared = prepared->versions.materials();
  return kept.value;
}

const std::vector<bool>& UsedMaterials(const FramePlan& plan, const PreparedMaterials& materials,
                                       PreparedScene* prepared) {
  const bool splits = Has(materials.any, MaterialTrait::kSplit);
  const ViewKey key{
      prepared->shapes_made,
      prepared->versions.Of(splits ? SceneParts(ScenePart::kMaterials) : SceneParts()),
      {static_cast<double>(plan.scene->materials.size()), splits ? 1.0 : 0.0}};
  return prepared->used_materials.Get(key, [&] { return FindUsedMaterials(*plan.scene, splits); });
}

}  // namespace

FramePlan MakePlan(const Scene& scene, const RenderSettings& settings) {
  PreparedScene prepared;
  prepared.for_one_plan = true;
  return MakePlan(scene, settings, &prepared);
}

FramePlan MakePlan(const Scene& given, const RenderSettings& settings, PreparedScene* prepared) {
  FramePlan plan;
  plan.with_lights = AddVisibleLights(given, prepared);
  const Scene& scene = plan.with_lights ? plan.with_lights->scene : given;
  plan.scene = &scene;
  plan.frame = {0, 0, scene.image.width, scene.image.height};
  plan.window = FrameWindow(plan.frame, settings);
  plan.camera = MakeCameraFrame(scene.camera, scene.image.width, scene.image.height);
  Explanation* const why = &plan.why;
  PixelSampler sampler = MakePixelSampler(scene.image.filter, scene.image.spp, scene.image.seed);

  // Called between steps that may take long.
  const auto stop_if_cancelled = [&] { ThrowIfCancelled(settings.cancel); };
  stop_if_cancelled();
  PlanLayers(scene, settings, &plan.film, why);
  const Rgb ambient = SumAmbient(scene);
  const std::shared_ptr<const PreparedMaterials> materials =
      MaterialsOf(plan, !IsBlack(ambient), settings.threads, prepared);
  const std::vector<bool>& used = UsedMaterials(plan, *materials, prepared);
  plan.direct =
      PlanLights(scene, settings, plan.film.layers, plan.with_lights.get(), prepared, why);
  stop_if_cancelled();
  plan.hits = PlanHits(scene, settings, plan.window, plan.camera, sampler, prepared, why);
  stop_if_cancelled();
  const bool tree_for_shadows =
      PlanShadows(scene, settings, plan.hits, prepared, &plan.direct, why);
  if (settings.on_plan_progress) settings.on_plan_progress(0.8);
  stop_if_cancelled();
  BuildTrees(tree_for_shadows, settings, &plan.hits, why);
  stop_if_cancelled();
  plan.surfaces =
      PlanSurfaces(scene, settings, plan.camera, ambient, materials, used, &prepared->tables, why);
  plan.sampling = PlanSampling(
      scene, settings, std::move(sampler),
      {!plan.direct.sampled_lights.empty(), plan.surfaces.textured, WhyEveryPixel(plan, settings)},
      why);
  PlanFarLights(scene, settings, &plan.direct, why);
  if (settings.max_error > 0) plan.adaptive = PlanAdaptiveSampling(plan, settings, why);
  if (!scene.meshes.empty() && plan.hits.intersector != nullptr) {
    PlanShadowOrigins(scene, &plan.direct, why);
    plan.planning = ShadeMeshes(scene, settings, plan.surfaces, &plan.direct, why);
  }
  plan.film.camera = plan.camera;
  plan.film.background = plan.direct.background;
  plan.film.sky = plan.direct.sky.has_value();
  PlanSums(scene, settings, plan.sampling.sampler, &plan.film, why);
  PlanPositions(scene, settings, {plan.surfaces, plan.direct, plan.film}, &plan.hits, why);
  NoteMaterials({scene, *materials, used}, !plan.direct.sampled_lights.empty(), &why->notes);
  if (settings.max_error > 0) {
    NoteNarrowLobes({scene, *materials, used}, settings.max_samples, &why->notes);
  }
  return plan;
}

std::string ExplainPlan(const FramePlan& plan, const RenderStats* stats) {
  std::string text = "plan:\n";
  for (const PlanItem& item : plan.why.items) {
    text += fmt::format("  {}  {}: {}\n", item.used ? "used   " : "skipped", Printable(item.what),
                        Printable(item.reason));
  }
  // Work skipped above changes no bit. These methods do.
  text += "substitutions (which agree within a stated error):\n";
  for (const PlanItem& item : plan.why.substitutions) {
    text += fmt::format("  {}: {}\n", Printable(item.what), Printable(item.reason));
  }
  if (plan.why.substitutions.empty())
    text += "  none: every skip above leaves all bits as they are\n";
  if (stats == nullptr) return text;
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
