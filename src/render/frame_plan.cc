// SPDX-License-Identifier: Apache-2.0
#include "render/frame_plan.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "base/printable.h"
#include "render/camera.h"
#include "render/frame_window.h"
#include "render/hit_positions.h"
#include "render/mesh_glints.h"
#include "render/mesh_shading.h"
#include "render/plan_notes.h"
#include "render/shadow_origins.h"
#include "render/shadow_plan.h"
#include "render/texel_maps.h"
#include "render/white_level.h"

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
const char* WhyEveryPixel(const Scene& scene, const RenderSettings& settings,
                          const TracePlan& trace, const LightsPlan& lights,
                          const std::vector<Layer>& layers) {
  return settings.max_error > 0  ? "adaptive sampling makes its own samples"
         : !trace.by_bins        ? "which pixels these are is not known without bins"
         : lights.sky            ? "they see the sky"
         : scene.image.spp == 1  ? "the only sample of a pixel is at its centre"
         : ShowsNearest(layers)  ? "some layers show the hit nearest to the pixel's centre"
         : settings.general_path ? "the general path is asked for"
                                 : nullptr;
}

AdaptivePlan PlanAdaptiveSampling(const Scene& scene, const RenderSettings& settings,
                                  const Window& window, const CameraFrame& camera, bool binned,
                                  const SurfacePlan& surfaces, const LightsPlan& lights,
                                  Explanation* why) {
  AdaptivePlan adaptive;
  if (!(settings.max_error > 0)) return adaptive;
  const PixelFilter& filter = scene.image.filter;
  adaptive.max_error = settings.max_error;
  adaptive.max_samples = settings.max_samples;
  adaptive.sampling = PlanSampleLevels(scene, settings.max_samples);
  adaptive.filter_radius = std::max(filter.width / 2, 0.5);
  adaptive.center_error = CenterError(filter);
  adaptive.white = WhiteLevel(scene);
  adaptive.brightest = BrightestObject(scene, lights, adaptive.white);
  // Between pixel centres a texture may show anything, and so may a function of the caller's, which
  // may have edges of its own, as a toon shader has, and highlights of any width, and so may what
  // was measured, between the cells of its table. Triangles are not binned, so their edges are not
  // known.
  adaptive.footprints = CentersMaySuffice(scene) && binned && scene.meshes.empty() &&
                        !surfaces.splits && !surfaces.textured &&
                        !Has(surfaces.prepared->any, MaterialTrait::kMeasured) &&
                        !Has(surfaces.prepared->any, MaterialTrait::kUserModel);
  adaptive.texel_maps = FindTexelMaps(scene, lights, settings.max_error);
  adaptive.highlights = {FindHighlightLights(scene, lights), LobeWidths(surfaces.materials)};
  adaptive.mesh_glints = FindMeshGlints(scene, surfaces, adaptive.highlights, camera, window,
                                        kCellSize + adaptive.filter_radius + kMaxRareWidth,
                                        kMaxRareWidth * kMaxRareWidth, settings.threads);
  // The bins extend one pixel beyond the cell, because the pixels around a triangle tell whether it
  // is part of an edge or a rare feature.
  if (!scene.meshes.empty()) {
    adaptive.small_triangles = BinSmallTriangles(surfaces.primitives, MakeProjector(camera), window,
                                                 adaptive.filter_radius + 1, settings.threads);
  }
  const bool is_box = filter.kind == FilterKind::kBox && filter.width <= 1;
  if (is_box && adaptive.footprints) adaptive.box_half_side = filter.width / 2;
  if (filter.kind == FilterKind::kBox && binned && !lights.sky) {
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

std::shared_ptr<const PreparedMaterials> MaterialsOf(const Scene& scene, bool with_lights,
                                                     bool in_ambient, int threads,
                                                     PreparedScene* prepared) {
  // Lights that are shown have materials of their own, which are made with their shapes.
  const MaterialsKey key{
      with_lights ? prepared->shapes_made : 0,
      prepared->versions.Of(with_lights ? SceneParts(ScenePart::kLights) : SceneParts()),
      in_ambient, scene.materials.data(), scene.materials.size()};
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

const std::vector<bool>& UsedMaterials(const Scene& scene, const PreparedMaterials& materials,
                                       PreparedScene* prepared) {
  const bool splits = Has(materials.any, MaterialTrait::kSplit);
  const ViewKey key{
      prepared->shapes_made,
      prepared->versions.Of(splits ? SceneParts(ScenePart::kMaterials) : SceneParts()),
      {static_cast<double>(scene.materials.size()), splits ? 1.0 : 0.0}};
  return prepared->used_materials.Get(key, [&] { return FindUsedMaterials(scene, splits); });
}

}  // namespace

FramePlan MakePlan(const Scene& scene, const RenderSettings& settings) {
  PreparedScene prepared;
  prepared.for_one_plan = true;
  return MakePlan(scene, settings, &prepared);
}

FramePlan MakePlan(const Scene& given, const RenderSettings& settings, PreparedScene* prepared) {
  // Called between steps that may take long.
  const auto stop_if_cancelled = [&] { ThrowIfCancelled(settings.cancel); };
  Explanation why;
  std::shared_ptr<const SceneWithLights> with_lights = AddVisibleLights(given, prepared);
  const Scene& scene = with_lights ? with_lights->scene : given;
  const Window frame{0, 0, scene.image.width, scene.image.height};
  const Window window = FrameWindow(frame, settings);
  const CameraFrame camera = MakeCameraFrame(scene.camera, scene.image.width, scene.image.height);
  const PixelSampler sampler =
      MakePixelSampler(scene.image.filter, scene.image.spp, scene.image.seed);
  stop_if_cancelled();
  const std::vector<Layer> layers = PlanLayers(scene, settings, &why);
  const Rgb ambient = SumAmbient(scene);
  const std::shared_ptr<const PreparedMaterials> materials =
      MaterialsOf(scene, with_lights != nullptr, !IsBlack(ambient), settings.threads, prepared);
  const std::vector<bool>& used = UsedMaterials(scene, *materials, prepared);
  const TracedShapes shapes = PrepareShapes(scene, settings, camera, prepared);
  stop_if_cancelled();
  LightsPlan lights =
      PlanLights(scene, settings, layers, with_lights.get(), shapes, &prepared->tables, &why);
  stop_if_cancelled();
  TracePlan trace = PlanTrace(scene, settings, shapes, window, sampler, prepared, &why);
  stop_if_cancelled();
  ShadowPlan shadows = PlanShadows(scene, settings, shapes, lights, prepared, &why);
  if (settings.on_plan_progress) settings.on_plan_progress(0.8);
  stop_if_cancelled();
  BuildTrees(shapes, trace, shadows.tree, settings, &why);
  stop_if_cancelled();
  SurfacePlan surfaces =
      PlanSurfaces(scene, settings, camera, ambient, materials, used, &prepared->tables, &why);
  const bool sampled_lights = !lights.sampled.empty();
  SamplingPlan sampling = PlanSampling(
      scene, settings, sampler,
      {sampled_lights, surfaces.textured, WhyEveryPixel(scene, settings, trace, lights, layers)},
      &why);
  AdaptivePlan adaptive =
      PlanAdaptiveSampling(scene, settings, window, camera, trace.binned, surfaces, lights, &why);
  const bool offset_origins = PlanShadowOrigins(scene, shapes, shadows, &why);
  DirectPlan direct{shapes, std::move(lights), std::move(shadows), offset_origins};
  ShadedMeshes meshes = ShadeMeshes(scene, settings, surfaces, direct, &why);
  FilmPlan film = PlanFilm(scene, settings, layers, camera, direct.lights, sampler, &why);
  HitArrays hit_arrays = PlanHitArrays(settings, trace, surfaces, direct, layers, &why);
  NoteMaterials({scene, *materials, used}, sampled_lights, &why.notes);
  if (settings.max_error > 0) {
    NoteNarrowLobes({scene, *materials, used}, settings.max_samples, &why.notes);
  }
  return {.scene = &scene,
          .with_lights = std::move(with_lights),
          .frame = frame,
          .window = window,
          .camera = camera,
          .changed_settings = ChangedSettings(settings),
          .sampling = std::move(sampling),
          .hits = {shapes, std::move(trace), std::move(hit_arrays)},
          .surfaces = std::move(surfaces),
          .direct = std::move(direct),
          .meshes = std::move(meshes),
          .film = std::move(film),
          .adaptive = std::move(adaptive),
          .why = std::move(why)};
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
