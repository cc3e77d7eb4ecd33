// SPDX-License-Identifier: Apache-2.0
#include "render/film_plan.h"

#include <algorithm>

#include <fmt/format.h>

namespace nacre {

void PlanSampling(const Scene& scene, const RenderSettings& settings, RenderPlan* plan) {
  const int spp = scene.image.spp;
  plan->sampler = MakePixelSampler(scene.image.filter, spp, scene.image.seed);
  // One sample a pixel makes small batches; wider tiles fill them.
  plan->tile_width = settings.tile_size > 0 ? std::min(settings.tile_size, kWidestTile)
                                            : (spp == 1 ? kWidestTile : kStripRows);
  plan->samples_per_round =
      std::clamp(static_cast<int>(kBatchCapacity) / (plan->tile_width * kStripRows), 1, spp);
  if (settings.max_error > 0) {
    plan->items.push_back(
        {"sample pattern", true,
         fmt::format("{} independent Owen-scrambled Sobol patterns a pixel", kReplicates)});
    return;
  }
  plan->items.push_back({"sample pattern", spp > 1,
                         spp > 1 ? fmt::format("{} Owen-scrambled Sobol samples a pixel", spp)
                                 : "one sample a pixel goes through its centre"});
}

// Samples beside all outlines hit nothing: that they are there is all that need be known, unless
// someone asks where. Tiles that triangles are in sight of place all of theirs.
void PlanPlaces(const Scene& scene, const RenderSettings& settings, RenderPlan* plan) {
  const bool nearest = std::any_of(plan->channels.begin(), plan->channels.end(),
                                   [](ChannelKind kind) { return kind != ChannelKind::kAveraged; });
  const char* const why = scene.spheres.empty()    ? "there are no spheres"
                          : settings.max_error > 0 ? "each block of pixels places its own"
                          : !plan->tiles           ? "Embree looks for every ray's hit"
                          : settings.general_path  ? "the general path is asked for"
                          : plan->sky != nullptr   ? "they see the sky"
                          : plan->splits           ? "some material depends on where samples lie"
                          : nearest ? "some layers show the hit nearest to the pixel's centre"
                                    : nullptr;
  plan->places_unasked = why == nullptr;
  plan->items.push_back({plan->sampler.centered ? "places of samples in memory"
                                                : "places of samples beside the spheres",
                         why != nullptr,
                         why != nullptr           ? why
                         : plan->sampler.centered ? "they are the pixels' centres"
                                                  : "outside the outlines they hit nothing"});
}

// A pixel's only sample, of weight 1, is its value.
void PlanFilm(const Scene& scene, const RenderSettings& settings, RenderPlan* plan) {
  const bool averages =
      std::all_of(plan->channels.begin(), plan->channels.end(),
                  [](ChannelKind kind) { return kind == ChannelKind::kAveraged; });
  const char* const why = settings.max_error > 0  ? "pixels take as many samples as they need"
                          : scene.image.spp > 1   ? "a pixel takes several samples"
                          : settings.general_path ? "the general path is asked for"
                          : !averages             ? "some layers are not averages"
                          : plan->sky != nullptr  ? "every pixel shows the sky or a hit"
                          : !HasUnitWeights(plan->sampler) ? "samples have weights"
                                                           : nullptr;
  plan->one_sample = why == nullptr;
  plan->items.push_back({"sums of samples", !plan->one_sample,
                         plan->one_sample ? "a pixel's only sample is its value" : why});
}

// With one light the parts need not be kept to be added up, unless samples might cancel: what
// rounds a sample's sum may then be more than what is left of the pixel.
void PlanParts(const Scene& scene, const RenderSettings& settings, RenderPlan* plan) {
  const auto shows_parts = [](const Layer& layer) {
    return layer.kind == LayerKind::kDiffuse || layer.kind == LayerKind::kSpecular ||
           layer.kind == LayerKind::kLight;
  };
  const bool interpolated =
      std::any_of(scene.meshes.begin(), scene.meshes.end(), [](const Mesh& mesh) {
        return mesh.interpolation == Interpolation::kFlat ||
               mesh.interpolation == Interpolation::kGouraud;
      });
  const char* const many = plan->lights.size() != 1 || !plan->sampled_lights.empty()
                               ? "what several lights leave, or none, is added up part by part"
                           : !HasUnitWeights(plan->sampler) ? "samples have weights"
                           : interpolated ? "what some meshes reflect is interpolated"
                                          : nullptr;
  plan->one_light = many == nullptr;
  const char* const why = many != nullptr         ? many
                          : settings.general_path ? "the general path is asked for"
                          : std::any_of(plan->layers.begin(), plan->layers.end(), shows_parts)
                              ? "layers show them"
                              : nullptr;
  if (plan->one_light) plan->leaves = why == nullptr ? Leaves::kSum : Leaves::kPartsAndSum;
  plan->items.push_back({"diffuse and specular parts", why != nullptr,
                         why != nullptr ? why : "one light leaves their sum, and no layer asks"});
}

}  // namespace nacre
