// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive_plan.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

#include "base/overloaded.h"
#include "sampling/hash.h"
#include "shading/measured_model.h"
#include "shading/user_model.h"

namespace nacre {
namespace {

// The angle at which the material's narrowest lobe has fallen to about half its peak, in radians;
// infinite without a lobe.
double NarrowestLobe(const ShadingMaterial& material) {
  const double infinity = std::numeric_limits<double>::infinity();
  double narrowest = infinity;
  for (const auto& coat : material.coats) narrowest = std::min(narrowest, NarrowestLobe(*coat));
  for (const LayerModel& layer : material.layers) {
    narrowest = std::min(narrowest, LayerLobeWidth(layer));
  }
  const double of_model = std::visit(
      Overloaded{[&](const PhongFamilyModel& phong) {
                   const bool matte = phong.specular.length2() == 0;
                   return matte ? infinity : std::sqrt(2 / (phong.shininess + 2));
                 },
                 [&](const MicrofacetModel& microfacet) {
                   return microfacet.delta ? infinity : microfacet.alpha;
                 },
                 [](const UserModel& user) { return UserLobeWidth(user); },
                 [](const MeasuredModel& measured) { return MeasuredLobeWidth(measured); },
                 [&](const MatteModel&) { return infinity; },
                 [&](const std::monostate&) { return infinity; }},
      material.model);
  return std::min(narrowest, of_model);
}

bool HasBothSigns(const PixelFilter& filter) { return !MakeFilterSampler(filter).negative.empty(); }

// Whether a spot light has a hard edge, which may lie between pixel centres unnoticed.
bool HasHardCone(const Scene& scene) {
  return std::any_of(scene.lights.begin(), scene.lights.end(), [](const Light& light) {
    const auto* spot = std::get_if<SpotLight>(&light.kind);
    return spot != nullptr && spot->cutoff_deg - spot->inner_deg < 1;
  });
}

}  // namespace

SampleLevels PlanSampleLevels(const Scene& scene, int max_samples) {
  SampleLevels plan;
  const PixelFilter& filter = scene.image.filter;
  const bool both_signs = HasBothSigns(filter);
  const auto add_pattern = [&](int samples) {
    auto& pattern = plan.patterns.emplace_back();
    for (size_t r = 0; r < kReplicates; ++r) {
      const uint64_t key = HashCombine(plan.patterns.size() * kReplicates + r, scene.image.seed);
      pattern[r] = MakeReplicateSampler(filter, samples, static_cast<uint32_t>(key));
    }
  };
  // A filter with negative lobes needs several samples, some of which have negative weights.
  int count = both_signs ? 4 : 1;
  int total = 0;
  while (kReplicates * total < max_samples) {
    if (plan.levels.size() > 1) count *= 2;
    if (both_signs) {
      add_pattern(count);
      plan.levels.push_back({plan.patterns.size() - 1, 0, count});
    } else {
      plan.levels.push_back({0, total, count});
    }
    total += count;
  }
  if (!both_signs) add_pattern(total);
  return plan;
}

bool CentersMaySuffice(const Scene& scene) {
  // With lights that are sampled, one sample of a pixel is noisy however smooth the surface is.
  const bool sampled = std::ranges::any_of(scene.lights, [](const Light& light) {
    return !IsPunctual(light) && !std::holds_alternative<AmbientLight>(light.kind);
  });
  return !HasBothSigns(scene.image.filter) && !HasHardCone(scene) && !sampled;
}

// The mean over a pixel differs from the value at its centre by half the second moment of |filter|
// along one axis, in pixels squared, times the second derivative. That is where the picture is
// smooth; the error is up to three times that where its slope changes within a pixel, as where a
// surface turns away from a light (for a box: 1/8 of the change of slope instead of 1/24).
double CenterError(const PixelFilter& filter) {
  constexpr int kSteps = 4096;
  double sum = 0, moment = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double x = (i + 0.5) / kSteps * filter.width / 2;
    const double value = std::abs(FilterValue(filter, x));
    sum += value;
    moment += value * x * x;
  }
  return 1.5 * (moment / sum);
}

std::vector<double> LobeWidths(std::span<const ShadingMaterial> materials) {
  std::vector<double> widths(materials.size());
  std::ranges::transform(materials, widths.begin(), NarrowestLobe);
  return widths;
}

}  // namespace nacre
