// SPDX-License-Identifier: Apache-2.0
#include "render/fast_lights.h"

#include <fmt/format.h>

#include "light/harmonics_error.h"
#include "shading/fast_sky.h"

namespace nacre {
namespace {

IrradianceHarmonics<float> Round(const IrradianceHarmonics<double>& harmonics) {
  IrradianceHarmonics<float> rounded;
  for (size_t i = 0; i < kHarmonics; ++i) {
    rounded.coefficients[i] = Vec3f(harmonics.coefficients[i]);
  }
  return rounded;
}

}  // namespace

std::string PlanFastLight(const Light& light, const RenderSettings& settings,
                          SampledLight* prepared, RenderPlan* plan) {
  const bool fast = settings.fast_lights && settings.closed_forms;
  if (!fast || prepared->form != SampledForm::kPictureSky) return "in closed form";
  const EnvironmentMap& map = *prepared->sky.picture;
  const IrradianceHarmonics<double> harmonics = ProjectIrradiance(map, settings.threads);
  const HarmonicsError error = MeasureHarmonics(map, harmonics, settings.threads);
  prepared->sky.fast = std::make_shared<FastSky>(FastSky{Round(harmonics)});
  plan->fast_lights.push_back({light.name, "harmonics", error.normals, error.rms, error.worst});
  return fmt::format(
      "from spherical harmonics to order 2, off by {:.2g} % of the mean irradiance (rms; at worst "
      "{:.2g} %) at {} normals,",
      100 * error.rms, 100 * error.worst, error.normals);
}

}  // namespace nacre
