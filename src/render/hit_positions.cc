// SPDX-License-Identifier: Apache-2.0
#include "render/hit_positions.h"

#include <algorithm>

#include <fmt/format.h>

namespace nacre {
namespace {

bool ReadsPositions(const PlannedPunctualLight& planned) {
  return planned.light.form != LightForm::kDirectional && planned.light.from_spheres.empty();
}

// The reason why the positions of all hits are needed; null if there is none.
const char* WhyAllPositions(const Scene& scene, const RenderSettings& settings,
                            const HitReaders& readers, const HitsPlan& plan) {
  const std::vector<PlannedPunctualLight>& lights = readers.direct.lights;
  const bool near = std::any_of(lights.begin(), lights.end(), ReadsPositions);
  return settings.general_path                    ? "the general path is asked for"
         : !plan.trace_by_bins                    ? "camera rays go through a tree"
         : !scene.meshes.empty()                  ? "spheres and triangles are sorted by depth"
         : near                                   ? "lights are found from them"
         : !readers.direct.sampled_lights.empty() ? "some lights have an extent"
         : readers.surfaces.textured              ? "textures may need them"
         : plan.exact_directions                  ? "narrow lobes find lights from them"
         : readers.surfaces.emits_in_front_only   ? "some materials emit in front only"
         : ShowsNearest(readers.film)             ? "some layers show hits, not averages"
                                                  : nullptr;
}

}  // namespace

void PlanPositions(const Scene& scene, const RenderSettings& settings, const HitReaders& readers,
                   HitsPlan* plan, Explanation* why) {
  plan->exact_directions = NeedsExactDirections(readers.surfaces);
  if (plan->intersector == nullptr) return;
  const char* const reason = WhyAllPositions(scene, settings, readers, *plan);
  plan->all_positions = reason != nullptr;
  if (reason != nullptr) {
    why->items.push_back({"positions of hits", true, reason});
    return;
  }
  const std::vector<PlannedPunctualLight>& lights = readers.direct.lights;
  plan->may_be_shadowed.resize(scene.spheres.size());
  for (uint32_t sphere = 0; sphere < scene.spheres.size(); ++sphere) {
    plan->may_be_shadowed[sphere] = std::any_of(
        lights.begin(), lights.end(),
        [&](const PlannedPunctualLight& planned) { return !NeverShadowed(planned, sphere); });
  }
  const auto count =
      std::count(plan->may_be_shadowed.begin(), plan->may_be_shadowed.end(), uint8_t{1});
  why->items.push_back({"positions of hits", count > 0,
                        count > 0 ? fmt::format("only shadow rays read them, of {} of {} spheres",
                                                count, scene.spheres.size())
                                  : "nothing reads them: normals are enough"});
}

}  // namespace nacre
