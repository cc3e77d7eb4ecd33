// SPDX-License-Identifier: Apache-2.0
#include "render/fast_lights.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "light/harmonics_error.h"
#include "render/plan_notes.h"
#include "shading/fast_area.h"

namespace nacre {
namespace {

IrradianceHarmonics<float> Round(const IrradianceHarmonics<double>& harmonics) {
  IrradianceHarmonics<float> rounded;
  for (size_t i = 0; i < kHarmonics; ++i) {
    rounded.coefficients[i] = Vec3f(harmonics.coefficients[i]);
  }
  return rounded;
}

// Widths of lobes that a light has images for; more are sampled.
constexpr size_t kMostLobes = 16;

// Gives the sky the image for the material's lobe. False if it is to be sampled.
bool AddLobe(const ShadingMaterial& material, const EnvironmentMap* image, int threads,
             FastSky* fast) {
  if (!HasFastLobe(material)) return false;
  if (image == nullptr) return true;  // a constant sky
  const double alpha = std::get<MicrofacetModel>(material.model).alpha;
  if (FindLobe(*fast, alpha) != nullptr) return true;
  if (fast->lobes.size() == kMostLobes) return false;
  fast->lobes.push_back(Prefilter(*image, alpha, threads));
  return true;
}

// The errors of several materials.
struct Errors {
  FastLight told;
  double squares = 0;
  size_t materials = 0;
  std::string worst{};

  void Add(const FastLobeError& error, const std::string& material) {
    if (error.worst >= told.worst) worst = material;
    told.worst = std::max(told.worst, error.worst);
    told.points += error.points;
    squares += error.rms * error.rms;
    told.rms = std::sqrt(squares / static_cast<double>(++materials));
  }
};

void PlanLobes(const Scene& scene, const RenderSettings& settings, PlannedSampledLight* planned,
               RenderPlan* plan) {
  const std::string& name = scene.lights[planned->index].name;
  const std::vector<bool> used = FindUsedMaterials(scene);
  const auto fast = std::make_shared<FastSky>(*planned->light.sky.fast);
  planned->light.sky.fast = fast;
  const std::shared_ptr<const EnvironmentMap> image =
      IsColored(planned->light) ? ImageOf(planned->light) : nullptr;
  Errors errors{.told = {name, "split sum"}};
  for (size_t i = 0; i < scene.materials.size(); ++i) {
    const ShadingMaterial& material = plan->materials[i];
    if (!used[i] || !AddLobe(material, image.get(), settings.threads, fast.get())) continue;
    errors.Add(MeasureFastLobe(material, planned->light, settings.threads),
               scene.materials[i].name);
  }
  if (errors.materials == 0) return;
  const FastLight& told = errors.told;
  plan->substitutions.push_back(
      {fmt::format("light \"{}\", lobes", name), true,
       fmt::format(
           "of {} materials by split sum, from {} blurred images, where all of the light is seen: "
           "off by {:.2g} % of a material's mean (rms; at worst {:.2g} %, \"{}\") at {} points; "
           "other lobes sampled",
           errors.materials, fast->lobes.size(), 100 * told.rms, 100 * told.worst, errors.worst,
           told.points)});
  plan->fast_lights.push_back(told);
}

void PlanTransformedLobes(const Scene& scene, const RenderSettings& settings,
                          const PlannedSampledLight& planned, RenderPlan* plan) {
  const std::string& name = scene.lights[planned.index].name;
  const std::vector<bool> used = FindUsedMaterials(scene);
  Errors errors{.told = {name, "linearly transformed cosines"}};
  for (size_t i = 0; i < scene.materials.size(); ++i) {
    const ShadingMaterial& material = plan->materials[i];
    if (!used[i] || !HasTransformedLobe(planned.light, material)) continue;
    errors.Add(MeasureTransformedLobe(material, planned.light, settings.threads),
               scene.materials[i].name);
  }
  if (errors.materials == 0) return;
  const FastLight& told = errors.told;
  plan->substitutions.push_back(
      {fmt::format("light \"{}\", lobes", name), true,
       fmt::format(
           "of {} materials by linearly transformed cosines where all of the light is seen: "
           "off by {:.2g} % of a material's mean (rms; at worst {:.2g} %, \"{}\") at {} "
           "points around the light; other lobes sampled",
           errors.materials, 100 * told.rms, 100 * told.worst, errors.worst, told.points)});
  plan->fast_lights.push_back(told);
}

}  // namespace

std::string PlanFastLight(const Light& light, const RenderSettings& settings,
                          SampledLight* prepared, RenderPlan* plan) {
  const bool fast = (settings.fast_lights || light.fast) && settings.closed_forms;
  const bool flat = prepared->form == SampledForm::kRectangle ||
                    (prepared->form == SampledForm::kMesh && HasIrradiance(*prepared));
  prepared->transformed_cosines = fast && flat;
  if (!fast || !IsSky(*prepared)) return "in closed form";
  if (prepared->form != SampledForm::kPictureSky) {
    prepared->sky.fast = std::make_shared<FastSky>();
    return "in closed form";
  }
  const EnvironmentMap& map = *prepared->sky.picture;
  const IrradianceHarmonics<double> harmonics = ProjectIrradiance(map, settings.threads);
  const HarmonicsError error = MeasureHarmonics(map, harmonics, settings.threads);
  prepared->sky.fast = std::make_shared<FastSky>(FastSky{Round(harmonics), {}});
  plan->fast_lights.push_back({light.name, "harmonics", error.normals, error.rms, error.worst});
  return fmt::format(
      "from spherical harmonics to order 2, off by {:.2g} % of the mean irradiance (rms; at worst "
      "{:.2g} %) at {} normals,",
      100 * error.rms, 100 * error.worst, error.normals);
}

void PlanFastLobes(const Scene& scene, const RenderSettings& settings, RenderPlan* plan) {
  for (PlannedSampledLight& planned : plan->sampled_lights) {
    if (planned.light.sky.fast != nullptr) PlanLobes(scene, settings, &planned, plan);
    if (planned.light.transformed_cosines) PlanTransformedLobes(scene, settings, planned, plan);
  }
}

}  // namespace nacre
