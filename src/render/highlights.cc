// SPDX-License-Identifier: Apache-2.0
#include "render/highlights.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include "light/environment.h"
#include "sampling/hash.h"

namespace nacre {
namespace {

// Adds the suns of a sky. Directions are sampled in proportion to their light, so that a sun that
// matters is sampled more than once.
void AddSuns(const ShadingSky& sky, std::vector<HighlightLight>* suns) {
  constexpr size_t kDirections = 1024, kMostSuns = 4;
  constexpr double kWidest = 0.1;     // a sun's radius, in radians
  constexpr double kBrightness = 16;  // of a sun, in units of the mean of the whole sky
  const EnvironmentMap& map = *sky.picture;
  if (map.is_black) return;
  struct Seen {
    Vec3d direction;
    double luminance;
  };
  std::vector<Seen> seen;
  for (size_t i = 0; i < kDirections; ++i) {
    const double u = (static_cast<double>(i) + 0.5) / kDirections;
    const double v = static_cast<double>(HashCombine(i, 0) >> 11) * 0x1p-53;
    const auto sample = SampleEnvironment<double>(map, v, u);
    seen.push_back({sample.to_light, sample.texel.pdf * map.sum});
  }
  for (size_t i = 0; i < kMostSuns && !seen.empty(); ++i) {
    const Seen brightest = *std::ranges::max_element(seen, {}, &Seen::luminance);
    if (!(brightest.luminance * 4 * M_PI > kBrightness * map.sum)) return;
    Vec3d sum(0);
    size_t count = 0;
    const auto is_part = [&](const Seen& s) {
      return (s.direction - brightest.direction).length() < kWidest &&
             2 * s.luminance > brightest.luminance;
    };
    for (const Seen& s : seen) {
      if (!is_part(s)) continue;
      sum += s.direction;
      ++count;
    }
    const Vec3d middle = sum.normalized();
    double radius = M_PI / map.height / 2;  // of a texel
    for (const Seen& s : seen) {
      if (is_part(s)) radius = std::max(radius, (s.direction - middle).length());
    }
    std::erase_if(seen, [&](const Seen& s) {
      return (s.direction - brightest.direction).length() < 2 * kWidest;
    });
    if (count < 2) continue;
    const Vec3d to_sun(middle.x * sky.cos_rotation + middle.z * sky.sin_rotation, middle.y,
                       middle.z * sky.cos_rotation - middle.x * sky.sin_rotation);
    suns->push_back({suns->size(), true, to_sun, radius});
  }
}

}  // namespace

std::vector<HighlightLight> FindHighlightLights(const Scene& scene, const LightsPlan& plan) {
  std::vector<HighlightLight> lights;
  for (const PlannedPunctualLight& planned : plan.punctual) {
    const auto& kind = scene.lights[planned.index].kind;
    if (const auto* sun = std::get_if<DirectionalLight>(&kind)) {
      lights.push_back({lights.size(), true, -sun->direction_of_travel.normalized(), 0});
      continue;
    }
    const auto* point = std::get_if<PointLight>(&kind);
    const Vec3d& position = point != nullptr ? point->position : std::get<SpotLight>(kind).position;
    lights.push_back({lights.size(), false, position - scene.camera.position, 0});
  }
  size_t number = lights.size();
  for (const PlannedSampledLight& planned : plan.sampled) {
    if (IsSky(planned.light)) continue;
    const LightBall ball = BoundingBall(planned.light);
    lights.push_back({number++, false, ball.center, ball.radius});
  }
  return lights;
}

std::vector<HighlightLight> FindSuns(const std::vector<PlannedSampledLight>& lights) {
  std::vector<HighlightLight> suns;
  for (const PlannedSampledLight& planned : lights) {
    const SampledLight& light = planned.light;
    if (light.form == SampledForm::kPictureSky) AddSuns(light.sky, &suns);
  }
  return suns;
}

double HalfVectorWidth(const SurfacePlan& surfaces, const HighlightCauses& causes,
                       uint32_t material) {
  const ShadingMaterial& prepared = surfaces.materials[material];
  if (HasMirror(prepared)) return 0;
  const auto* phong = std::get_if<PhongFamilyModel>(&prepared.model);
  const bool mirrored = phong != nullptr && phong->model != PhongModel::kBlinnPhong;
  return causes.lobe_widths[material] * (mirrored ? 0.5 : 1);
}

}  // namespace nacre
