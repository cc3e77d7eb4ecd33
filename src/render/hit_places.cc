// SPDX-License-Identifier: Apache-2.0
#include "render/hit_places.h"

#include <algorithm>

#include <fmt/format.h>

#include "scene/scene.h"
#include "shading/light.h"

namespace nacre {
namespace {

// Of more spheres many batches hold hits on several, whose offsets are gathered hit by hit.
constexpr size_t kMostSpheres = 64;

bool LieOnSpheres(const Scene& scene, const RenderPlan& plan) {
  return scene.meshes.empty() && scene.spheres.size() <= kMostSpheres && plan.eye_outside;
}

bool ReadsPositions(const PlannedLight& planned) {
  return planned.light.form != LightForm::kDirectional && planned.light.from_spheres.empty();
}

// What reads the positions of all hits; null: nothing does.
const char* WhyAllPositions(const Scene& scene, const RenderSettings& settings,
                            const RenderPlan& plan) {
  const bool near = std::any_of(plan.lights.begin(), plan.lights.end(), ReadsPositions);
  const bool averages = std::all_of(plan.layers.begin(), plan.layers.end(),
                                    [](const Layer& layer) { return IsAveraged(layer.kind); });
  return settings.general_path          ? "the general path is asked for"
         : !plan.tiles                  ? "camera rays are traced by Embree"
         : !scene.meshes.empty()        ? "spheres and triangles are sorted by depth"
         : near                         ? "lights are found from them"
         : !plan.sampled_lights.empty() ? "some lights have an extent"
         : plan.cull_lights             ? "lights are culled by them"
         : plan.exact_directions        ? "narrow lobes find lights from them"
         : plan.textured                ? "textures may need them"
         : plan.one_sided               ? "some materials emit in front only"
         : !averages                    ? "some layers show hits, not averages"
                                        : nullptr;
}

}  // namespace

void PlanLightOffsets(const Scene& scene, const RenderSettings& settings, RenderPlan* plan) {
  if (!settings.offsets_by_normal || !LieOnSpheres(scene, *plan)) return;
  for (PlannedLight& planned : plan->lights) {
    if (!OffsetFromSpheres(scene.spheres, scene.camera.position, &planned.light)) continue;
    plan->substitutions.push_back(
        {fmt::format("light \"{}\"", scene.lights[planned.index].name), true,
         fmt::format("it is {} radii or more from every sphere's centre: where it lies from a hit "
                     "is found from the hit's normal, to 2e-7 of their distance",
                     kFarRadii)});
  }
}

void PlanPositions(const Scene& scene, const RenderSettings& settings, RenderPlan* plan) {
  if (plan->intersector == nullptr) return;
  const char* const why = WhyAllPositions(scene, settings, *plan);
  plan->all_positions = why != nullptr;
  if (why != nullptr) {
    plan->items.push_back({"positions of hits", true, why});
    return;
  }
  plan->may_be_shadowed.resize(scene.spheres.size());
  for (uint32_t sphere = 0; sphere < scene.spheres.size(); ++sphere) {
    plan->may_be_shadowed[sphere] =
        std::any_of(plan->lights.begin(), plan->lights.end(),
                    [&](const PlannedLight& planned) { return !NeverShadowed(planned, sphere); });
  }
  const auto count =
      std::count(plan->may_be_shadowed.begin(), plan->may_be_shadowed.end(), uint8_t{1});
  plan->items.push_back({"positions of hits", count > 0,
                         count > 0 ? fmt::format("only shadow rays read them, of {} of {} spheres",
                                                 count, scene.spheres.size())
                                   : "normals tell all that is asked"});
}

bool NeedsPositions(const RenderPlan& plan, const TileCandidates& candidates) {
  if (plan.all_positions) return true;
  const auto casts = [&](const TileCandidate& candidate) {
    return plan.may_be_shadowed[candidate.primitive] != 0;
  };
  return std::any_of(candidates.cells.begin(), candidates.cells.end(), [&](const auto& cell) {
    return std::any_of(cell.begin(), cell.end(), casts);
  });
}

}  // namespace nacre
