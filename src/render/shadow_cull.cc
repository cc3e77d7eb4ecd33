// SPDX-License-Identifier: Apache-2.0
#include "render/shadow_cull.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "base/parallel.h"

namespace nacre {
namespace {

// True if every camera ray surely starts outside the sphere. The margins are far more than what
// the roundings of the tests can amount to.
bool IsOutside(const Scene& scene, const Vec3d& forward, const Sphere& sphere) {
  const Vec3d offset = sphere.center - scene.camera.position;
  const double clear = sphere.radius * (1 + 1e-9);
  if (scene.camera.projection == Projection::kPerspective) return offset.length2() > clear * clear;
  // Wholly before or behind the image plane.
  const double pixel = scene.camera.height / scene.image.height;
  const double plane = pixel * (scene.image.height + scene.image.width);
  return std::abs(offset.dot(forward)) > clear + 1e-12 * (offset.length() + plane);
}

// Adds the items of the lights; of many that are alike the first speaks for all.
void AddItems(std::vector<PlanItem> items, RenderPlan* plan) {
  constexpr size_t kMost = 8;
  std::map<std::pair<bool, std::string>, std::vector<PlanItem*>> alike;
  for (PlanItem& item : items) alike[{item.used, item.reason}].push_back(&item);
  for (PlanItem& item : items) {
    const std::vector<PlanItem*>& same = alike[{item.used, item.reason}];
    if (same.size() > kMost && same.front() != &item) continue;
    plan->items.push_back(item);
    if (same.size() > kMost) {
      plan->items.back().what += fmt::format(" and those of {} more", same.size() - 1);
    }
  }
}

// For each sphere 1 if anything can come between it and the light.
std::vector<uint8_t> FindShadowed(const OccluderLists& lists) {
  std::vector<uint8_t> shadowed(lists.end.size());
  for (size_t i = 0; i < shadowed.size(); ++i) shadowed[i] = lists.Begin(i) < lists.end[i] ? 1 : 0;
  return shadowed;
}

// Takes from the light the shadow rays that nothing can be in the way of; says why in `item`.
void SkipUnshadowed(const OccluderLists& lists, PlannedLight* light, PlanItem* item) {
  std::vector<uint8_t> shadowed = FindShadowed(lists);
  const auto count = std::count(shadowed.begin(), shadowed.end(), uint8_t{1});
  const size_t spheres = shadowed.size();
  if (count == 0) {
    light->shadow_rays = item->used = false;
    item->reason = spheres == 1 ? "a sphere alone, seen from outside, is convex"
                                : "no sphere is between another and the light";
    return;
  }
  item->reason = fmt::format("{} of {} spheres can lie in another's shadow", count, spheres);
  if (static_cast<size_t>(count) == spheres) return;
  item->reason = "only " + item->reason;
  light->shadowed = std::move(shadowed);
}

// Why a tree is better than the bins, or nothing.
std::string WhyNotBins(const LightBins& bins) {
  constexpr double kCrowd = 2000;
  constexpr size_t kLarge = 32;
  if (bins.overfull) return "the light's cells would hold more than 2^28 spheres";
  if (bins.meeting > kCrowd) {
    return fmt::format("{:.0f} spheres meet in a light's cell", bins.meeting);
  }
  if (bins.large.size() > kLarge) {
    return fmt::format("{} spheres cover many of a light's cells", bins.large.size());
  }
  return {};
}

constexpr char kEmbreeAskedFor[] = "--intersector embree";

// Why shadow rays need a tree whatever the lights, or nothing.
std::string WhyTree(const Scene& scene, const RenderSettings& settings, const RenderPlan& plan) {
  if (settings.general_path) return "the general path is asked for";
  if (!scene.meshes.empty()) return "there are triangles";
  if (settings.intersector == IntersectorChoice::kEmbree) return kEmbreeAskedFor;
  if (scene.spheres.size() > kMaxListedSpheres && plan.intersector->SpheresAreNested()) {
    return kNestedSpheres;
  }
  if (settings.intersector == IntersectorChoice::kTiles) return {};
  // Measured: by then one tree is made faster than the bins of all lights, and takes less room.
  constexpr double kMostPairs = 8e6;
  const auto lights = std::count_if(plan.lights.begin(), plan.lights.end(),
                                    [](const PlannedLight& light) { return light.shadow_rays; });
  if (static_cast<double>(lights) * static_cast<double>(scene.spheres.size()) > kMostPairs &&
      lights > 1) {
    return fmt::format("one tree is less work than bins for {} lights", lights);
  }
  return {};
}

std::string DescribeBins(const LightBins& bins) {
  return fmt::format("{} cells, {} entries, {:.1f} meet in one, {} are in every ray's way",
                     bins.end.size(), bins.entries(), bins.meeting, bins.large.size());
}

}  // namespace

bool EyeIsOutside(const Scene& scene, int threads) {
  const Vec3d forward = (scene.camera.look_at - scene.camera.position).normalized();
  constexpr size_t kBlock = size_t{1} << 14;
  const size_t blocks = (scene.spheres.size() + kBlock - 1) / kBlock;
  std::vector<uint8_t> outside(blocks);
  ParallelFor(blocks, threads, [&](size_t block) {
    const Sphere* const spheres = scene.spheres.data();
    const size_t end = std::min((block + 1) * kBlock, scene.spheres.size());
    outside[block] =
        std::all_of(spheres + block * kBlock, spheres + end,
                    [&](const Sphere& sphere) { return IsOutside(scene, forward, sphere); });
  });
  return std::all_of(outside.begin(), outside.end(), [](uint8_t all) { return all != 0; });
}

bool PlanShadows(const Scene& scene, const RenderSettings& settings, RenderPlan* plan) {
  const bool few = scene.spheres.size() <= kMaxListedSpheres;
  const std::string why_tree = WhyTree(scene, settings, *plan);
  // Embree is asked about the same rays as the others, when it is asked for.
  if (why_tree.empty() || (few && why_tree == kEmbreeAskedFor)) {
    std::vector<const Light*> lights;
    for (PlannedLight& light : plan->lights) {
      if (!light.shadow_rays) continue;
      light.occluders = static_cast<uint32_t>(lights.size());
      lights.push_back(&scene.lights[light.index]);
    }
    plan->intersector->FindOccluders(lights, plan->eye_outside);
  }
  size_t listed = 0, binned = 0, left = 0;
  std::vector<PlanItem> items;
  std::string crowded, crowd;  // why bins are not used, or what they are like
  for (PlannedLight& light : plan->lights) {
    if (!light.shadow_rays) continue;
    PlanItem item{fmt::format("light \"{}\" shadow rays", scene.lights[light.index].name), true,
                  settings.general_path ? "the general path is asked for"
                                        : "something may lie between a surface and the light"};
    bool bins = false;
    if (light.occluders != kAnyLight) {
      const LightOccluders& found = plan->intersector->Occluders(light.occluders);
      if (few) SkipUnshadowed(found.lists, &light, &item);
      bins = light.shadow_rays && found.bins.has_value();
      if (bins && (settings.intersector == IntersectorChoice::kAuto || found.bins->overfull)) {
        crowded = WhyNotBins(*found.bins);
      }
      if (bins) crowd = DescribeBins(*found.bins);
      if (!crowded.empty() || !why_tree.empty()) light.occluders = kAnyLight;
    }
    if (light.shadow_rays) ++(light.occluders == kAnyLight ? left : bins ? binned : listed);
    items.push_back(std::move(item));
  }
  AddItems(std::move(items), plan);
  const std::string why_not = listed + binned + left == 0 ? "nothing is left for them"
                              : !why_tree.empty()         ? why_tree
                              : !crowded.empty()          ? crowded
                                                          : "others are faster here";
  plan->items.push_back(
      {"intersector lists, for shadow rays", listed > 0,
       listed > 0
           ? "each sphere's few possible occluders need no tree, and tiles with none of them "
             "on the way to the light cast no rays"
           : why_not});
  plan->items.push_back(
      {"intersector bins, for shadow rays", binned > 0,
       binned > 0 ? "spheres binned as the light sees them need no tree: " + crowd : why_not});
  return left > 0;
}

}  // namespace nacre
