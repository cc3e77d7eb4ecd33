// SPDX-License-Identifier: Apache-2.0
#include "render/shadow_plan.h"

#include <algorithm>
#include <map>
#include <utility>

#include <fmt/format.h>

namespace nacre {
namespace {

// Adds the items of the lights. If many are alike, only the first is listed.
void AddItems(std::vector<PlanItem> items, Explanation* why) {
  constexpr size_t kMaxAlike = 8;
  std::map<std::pair<bool, std::string>, std::vector<PlanItem*>> alike;
  for (PlanItem& item : items) alike[{item.used, item.reason}].push_back(&item);
  for (PlanItem& item : items) {
    const std::vector<PlanItem*>& same = alike[{item.used, item.reason}];
    if (same.size() > kMaxAlike && same.front() != &item) continue;
    why->items.push_back(item);
    if (same.size() > kMaxAlike) {
      why->items.back().what += fmt::format(" and those of {} more", same.size() - 1);
    }
  }
}

// Finds the spheres from which something can occlude the light, by lists. If there is none, turns
// off the light's shadow rays, unless light->trace_all. Explains it in `item`.
void SkipUnshadowed(const OccluderLists& lists, LightShadows* light, PlanItem* item) {
  const size_t spheres = lists.end.size();
  std::vector<uint8_t> shadowed(spheres);
  for (size_t i = 0; i < spheres; ++i) shadowed[i] = lists.Begin(i) < lists.end[i] ? 1 : 0;
  const auto count = static_cast<size_t>(std::ranges::count(shadowed, 1));
  item->reason = fmt::format("{} of {} spheres can lie in another's shadow", count, spheres);
  if (count == 0 && !light->trace_all) {
    light->rays = item->used = false;
    item->reason = spheres == 1 ? "a sphere alone, seen from outside, is convex"
                                : "no sphere is between another and the light";
  }
  if (count < spheres) light->shadowed = std::move(shadowed);
}

// Why a BVH is better than these bins; empty if it is not.
std::string WhyNotBins(const LightBins& bins) {
  constexpr double kCrowd = 2000;
  constexpr size_t kLarge = 32;
  if (bins.overfull) return "the light's cells would hold more than 2^28 spheres";
  if (bins.mean_occupancy > kCrowd) {
    return fmt::format("{:.0f} spheres meet in a light's cell", bins.mean_occupancy);
  }
  if (bins.large.size() > kLarge) {
    return fmt::format("{} spheres cover many of a light's cells", bins.large.size());
  }
  return {};
}

// Why the shadow rays of all lights use a BVH; empty if they need not.
std::string WhyTree(const Scene& scene, const RenderSettings& settings, const TracedShapes& shapes,
                    const std::vector<PlannedPunctualLight>& punctual) {
  if (settings.general_path) return "the general path is asked for";
  if (!scene.meshes.empty()) return "there are triangles";
  if (const char* const asked_for = TreeAskedFor(settings.intersector)) return asked_for;
  if (scene.spheres.size() > kMaxListedSpheres && shapes.intersector->SpheresAreNested()) {
    return kNestedSpheres;
  }
  if (settings.intersector == IntersectorChoice::kTiles) return {};
  // Measured: above this, one BVH is built faster than the bins of all lights, and is smaller.
  constexpr double kMaxPairs = 8e6;
  const auto lights = std::ranges::count(punctual, true, &PlannedPunctualLight::casts_shadows);
  if (static_cast<double>(lights) * static_cast<double>(scene.spheres.size()) > kMaxPairs &&
      lights > 1) {
    return fmt::format("one tree is less work than bins for {} lights", lights);
  }
  return {};
}

std::string DescribeBins(const LightBins& bins) {
  return fmt::format("{} cells, {} entries, {:.1f} meet in one, {} are in every ray's way",
                     bins.end.size(), bins.entries(), bins.mean_occupancy, bins.large.size());
}

// Lights that are occluded from everywhere, if they cast shadows.
template <class Planned>
std::vector<LightShadows> ShadowsOf(const std::vector<Planned>& lights) {
  std::vector<LightShadows> shadows(lights.size());
  for (size_t i = 0; i < lights.size(); ++i) shadows[i].rays = lights[i].casts_shadows;
  return shadows;
}

// A search for occluders. The intersector numbers lights in the order in which they are found here.
struct OccluderSearch {
  const Scene& scene;
  const RenderSettings& settings;
  const TracedShapes& shapes;
  bool known;          // an earlier plan has found the occluders of all lights
  uint32_t count = 0;  // the lights that this plan has come to so far
};

std::vector<LightShadows> PlanPunctualShadows(const std::vector<PlannedPunctualLight>& punctual,
                                              OccluderSearch* search, Explanation* why) {
  const Scene& scene = search->scene;
  const RenderSettings& settings = search->settings;
  const TracedShapes& shapes = search->shapes;
  const bool few = scene.spheres.size() <= kMaxListedSpheres;
  const std::string why_tree = WhyTree(scene, settings, shapes, punctual);
  // If the settings ask for a BVH, lists still decide which rays are traced: all intersectors must
  // trace the same rays.
  const char* const asked_for = TreeAskedFor(settings.intersector);
  std::vector<LightShadows> plan = ShadowsOf(punctual);
  if (why_tree.empty() || (few && asked_for != nullptr && why_tree == asked_for)) {
    std::vector<const Light*> lights;
    for (size_t i = 0; i < punctual.size(); ++i) {
      if (!plan[i].rays) continue;
      plan[i].occluders = static_cast<uint32_t>(lights.size());
      lights.push_back(&scene.lights[punctual[i].index]);
    }
    if (!search->known) shapes.intersector->FindOccluders(lights, shapes.eye_outside);
    search->count = static_cast<uint32_t>(lights.size());
  }
  size_t listed = 0, binned = 0, left = 0;
  std::vector<PlanItem> items;
  std::string crowded;  // why bins are not used for one of the lights
  std::string crowd;    // a description of the bins that are used
  for (size_t i = 0; i < punctual.size(); ++i) {
    LightShadows& light = plan[i];
    if (!light.rays) continue;
    PlanItem item{fmt::format("light \"{}\" shadow rays", scene.lights[punctual[i].index].name),
                  true,
                  settings.general_path ? "the general path is asked for"
                                        : "something may lie between a surface and the light"};
    bool bins = false;
    if (light.occluders != kAnyLight) {
      const LightOccluders& found = shapes.intersector->Occluders(light.occluders);
      if (few) SkipUnshadowed(found.lists, &light, &item);
      if (light.rays && !light.shadowed.empty()) item.reason = "only " + item.reason;
      bins = light.rays && found.bins.has_value();
      std::string why_not_bins;
      if (bins && (settings.intersector == IntersectorChoice::kAuto || found.bins->overfull)) {
        why_not_bins = WhyNotBins(*found.bins);
      }
      if (bins && why_not_bins.empty()) crowd = DescribeBins(*found.bins);
      if (!why_not_bins.empty() || !why_tree.empty()) light.occluders = kAnyLight;
      if (crowded.empty()) crowded = why_not_bins;
    }
    if (light.rays) ++(light.occluders == kAnyLight ? left : bins ? binned : listed);
    items.push_back(std::move(item));
  }
  AddItems(std::move(items), why);
  const std::string why_not = listed + binned + left == 0 ? "nothing is left for them"
                              : !why_tree.empty()         ? why_tree
                              : !crowded.empty()          ? crowded
                                                          : "others are faster here";
  why->items.push_back(
      {"intersector lists, for shadow rays", listed > 0,
       listed > 0
           ? "each sphere's few possible occluders need no tree, and tiles with none of them "
             "on the way to the light cast no rays"
           : why_not});
  why->items.push_back(
      {"intersector bins, for shadow rays", binned > 0,
       binned > 0 ? "spheres binned as the light sees them need no tree: " + crowd : why_not});
  return plan;
}

// The spheres that can occlude the light, by the sphere that is shaded.
const OccluderLists& ListKnownOccluders(const PlannedSampledLight& light, OccluderSearch* search,
                                        LightShadows* plan) {
  const TracedShapes& shapes = search->shapes;
  const std::optional<LightBall> ball =
      IsSky(light.light) ? std::nullopt : std::optional(BoundingBall(light.light));
  plan->occluders = search->count++;
  if (!search->known) {
    shapes.intersector->FindOccludersOfBall(ball, light.primitives, shapes.eye_outside);
  }
  return shapes.intersector->Occluders(plan->occluders).lists;
}

// Whether all triangles of the scene are the light's own shape, which casts no shadow of its light.
bool OwnsTriangles(const Scene& scene, const PlannedSampledLight& light) {
  return light.primitives.begin == scene.spheres.size() &&
         light.primitives.end == scene.spheres.size() + CountTriangles(scene);
}

// For scenes of few spheres, and no triangles but the light's: plans lists of spheres instead of a
// BVH, in which rays would visit all triangles around their ends. Without any triangles, the lists
// tell on which spheres the light can be occluded. This decides where diffuse reflection is in
// closed form, so it must be the same for all intersectors, even if they then use a BVH.
void PlanOccludingSpheres(const PlannedSampledLight& light, OccluderSearch* search,
                          LightShadows* plan, PlanItem* item) {
  const RenderSettings& settings = search->settings;
  const OccluderLists& lists = ListKnownOccluders(light, search, plan);
  const bool triangles = !search->scene.meshes.empty();
  if (!triangles) {
    plan->trace_all = settings.general_path;
    SkipUnshadowed(lists, plan, item);
  }
  if (settings.general_path || TreeAskedFor(settings.intersector) != nullptr ||
      lists.longest > kMaxSampledListLength) {
    plan->occluders = kAnyLight;
  } else if (triangles) {
    item->reason =
        fmt::format("spheres alone, {} at most, lie in the light's way: no tree", lists.longest);
  } else if (plan->rays) {
    item->reason += fmt::format(", each by {} others at most: no tree", lists.longest);
  }
}

std::vector<LightShadows> PlanSampledShadows(const std::vector<PlannedSampledLight>& sampled,
                                             OccluderSearch* search, Explanation* why) {
  const Scene& scene = search->scene;
  const bool few = scene.spheres.size() <= kMaxListedSpheres;
  std::vector<LightShadows> plan = ShadowsOf(sampled);
  for (size_t i = 0; i < sampled.size(); ++i) {
    const PlannedSampledLight& light = sampled[i];
    PlanItem item{fmt::format("light \"{}\" shadow rays", scene.lights[light.index].name),
                  light.casts_shadows, "something may lie between a surface and the light"};
    if (!light.casts_shadows) {
      item.reason = scene.image.shadows ? "the light casts none" : "the scene turns shadows off";
    } else if (few && (scene.meshes.empty() || OwnsTriangles(scene, light))) {
      PlanOccludingSpheres(light, search, &plan[i], &item);
    }
    why->items.push_back(std::move(item));
  }
  return plan;
}

bool NeedTree(const std::vector<LightShadows>& lights) {
  return std::any_of(lights.begin(), lights.end(), [](const LightShadows& light) {
    return light.rays && light.occluders == kAnyLight;
  });
}

}  // namespace

ShadowPlan PlanShadows(const Scene& scene, const RenderSettings& settings,
                       const TracedShapes& shapes, const LightsPlan& lights,
                       PreparedScene* prepared, Explanation* why) {
  if (shapes.intersector == nullptr) {
    return {ShadowsOf(lights.punctual), ShadowsOf(lights.sampled)};
  }
  const ViewKey key{
      prepared->intersectors_made,
      prepared->versions.Of(ScenePart::kLights | ScenePart::kCamera | ScenePart::kImage),
      {static_cast<double>(settings.intersector), settings.general_path ? 1.0 : 0.0,
       static_cast<double>(prepared->shapes_made)}};
  OccluderSearch search{scene, settings, shapes, prepared->lights.IsUpToDate(key)};
  if (!search.known) {
    prepared->lights.Forget();  // in case an exception ends the search
    shapes.intersector->ForgetOccluders();
  }
  ShadowPlan plan;
  plan.punctual = PlanPunctualShadows(lights.punctual, &search, why);
  plan.sampled = PlanSampledShadows(lights.sampled, &search, why);
  plan.tree = NeedTree(plan.punctual) || NeedTree(plan.sampled);
  prepared->lights.Set(key, {});
  return plan;
}

}  // namespace nacre
