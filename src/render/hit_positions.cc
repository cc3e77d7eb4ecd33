// SPDX-License-Identifier: Apache-2.0
#include "render/hit_positions.h"

#include <algorithm>

#include <fmt/format.h>

namespace nacre {
namespace {

// The reason why the positions of all hits are needed; null if there is none.
const char* WhyAllPositions(const Scene& scene, const RenderSettings& settings,
                            const TracePlan& trace, const SurfacePlan& surfaces,
                            const LightsPlan& lights, const std::vector<Layer>& layers) {
  const bool near = std::ranges::any_of(lights.punctual, [](const PlannedPunctualLight& planned) {
    return planned.light.form != LightForm::kDirectional && planned.light.from_spheres.empty();
  });
  return settings.general_path            ? "the general path is asked for"
         : !trace.by_bins                 ? "camera rays go through a tree"
         : !scene.meshes.empty()          ? "spheres and triangles are sorted by depth"
         : near                           ? "lights are found from them"
         : !lights.sampled.empty()        ? "some lights have an extent"
         : surfaces.textured              ? "textures may need them"
         : NeedsExactDirections(surfaces) ? "narrow lobes find lights from them"
         : surfaces.emits_in_front_only   ? "some materials emit in front only"
         : ShowsNearest(layers)           ? "some layers show hits, not averages"
                                          : nullptr;
}

}  // namespace

HitArrays PlanHitArrays(const RenderSettings& settings, const TracePlan& trace,
                        const SurfacePlan& surfaces, const DirectPlan& direct,
                        const std::vector<Layer>& layers, Explanation* why) {
  const Scene& scene = *direct.shapes.primitives.scene;
  HitArrays plan;
  plan.exact_directions = NeedsExactDirections(surfaces);
  if (direct.shapes.intersector == nullptr) return plan;
  const char* const reason =
      WhyAllPositions(scene, settings, trace, surfaces, direct.lights, layers);
  plan.all_positions = reason != nullptr;
  if (reason != nullptr) {
    why->items.push_back({"positions of hits", true, reason});
    return plan;
  }
  const std::vector<LightShadows>& lights = direct.shadows.punctual;
  plan.may_be_shadowed.resize(scene.spheres.size());
  const bool any_rays =
      std::ranges::any_of(lights, [](const LightShadows& light) { return light.rays; });
  for (uint32_t sphere = 0; any_rays && sphere < scene.spheres.size(); ++sphere) {
    plan.may_be_shadowed[sphere] = std::ranges::any_of(
        lights, [&](const LightShadows& light) { return !NeverShadowed(light, sphere); });
  }
  const auto count = std::ranges::count(plan.may_be_shadowed, 1);
  why->items.push_back({"positions of hits", count > 0,
                        count > 0 ? fmt::format("only shadow rays read them, of {} of {} spheres",
                                                count, scene.spheres.size())
                                  : "nothing reads them: normals are enough"});
  return plan;
}

}  // namespace nacre
