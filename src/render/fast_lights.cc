// SPDX-License-Identifier: Apache-2.0
#include "render/fast_lights.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

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

// measure(material): an error, or none if the material's lobe is to be sampled.
template <class Measure>
Errors MeasureLobes(const Scene& scene, const RenderPlan& plan, FastLight told,
                    const Measure& measure) {
  const std::vector<bool> used = FindUsedMaterials(scene);
  Errors errors{.told = std::move(told)};
  for (size_t i = 0; i < scene.materials.size(); ++i) {
    if (!used[i]) continue;
    const std::optional<FastLobeError> error = measure(plan.materials[i]);
    if (error) errors.Add(*error, scene.materials[i].name);
  }
  return errors;
}

// Tells the errors, if there are any: `how` the lobes are had, and `where` the points were.
void TellLobes(const Errors& errors, const std::string& how, const char* where, RenderPlan* plan) {
  if (errors.materials == 0) return;
  const FastLight& told = errors.told;
  plan->substitutions.push_back(
      {fmt::format("light \"{}\", lobes", told.light), true,
       fmt::format("of {} materials by {} where all of the light is seen: off by {:.2g} % of a "
                   "material's mean (rms; at worst {:.2g} %, \"{}\") at {} points{}; other lobes "
                   "sampled",
                   errors.materials, how, 100 * told.rms, 100 * told.worst, errors.worst,
                   told.points, where)});
  plan->fast_lights.push_back(told);
}

void PlanLobes(const Scene& scene, const RenderSettings& settings, PlannedSampledLight* planned,
               RenderPlan* plan) {
  const auto fast = std::make_shared<FastSky>(*planned->light.sky.fast);
  planned->light.sky.fast = fast;
  const std::shared_ptr<const EnvironmentMap> image =
      IsColored(planned->light) ? ImageOf(planned->light) : nullptr;
  const FastLight told{scene.lights[planned->index].name, "split sum"};
  const Errors errors = MeasureLobes(
      scene, *plan, told, [&](const ShadingMaterial& material) -> std::optional<FastLobeError> {
        if (!AddLobe(material, image.get(), settings.threads, fast.get())) return std::nullopt;
        return MeasureFastLobe(material, planned->light, settings.threads);
      });
  TellLobes(errors, fmt::format("split sum, from {} blurred images,", fast->lobes.size()), "",
            plan);
}

void PlanTransformedLobes(const Scene& scene, const RenderSettings& settings,
                          const PlannedSampledLight& planned, RenderPlan* plan) {
  constexpr const char* kMethod = "linearly transformed cosines";
  const FastLight told{scene.lights[planned.index].name, kMethod};
  const Errors errors = MeasureLobes(
      scene, *plan, told, [&](const ShadingMaterial& material) -> std::optional<FastLobeError> {
        if (!HasTransformedLobe(planned.light, material)) return std::nullopt;
        return MeasureTransformedLobe(material, planned.light, settings.threads);
      });
  TellLobes(errors, kMethod, " around the light", plan);
}

}  // namespace

std::string PlanFastLight(const Light& light, const RenderSettings& settings,
                          SampledLight* prepared, RenderPlan* plan) {
  const bool fast = (settings.fast_lights || light.fast) && settings.closed_forms;
  prepared->transformed_cosines = fast && !IsSky(*prepared) && HasIrradiance(*prepared);
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
