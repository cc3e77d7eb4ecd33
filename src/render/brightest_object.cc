// SPDX-License-Identifier: Apache-2.0
#include "render/brightest_object.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

#include "render/white_level.h"

namespace nacre {
namespace {

constexpr double kNoBound = std::numeric_limits<double>::infinity();

double MeanRadiance(const EnvironmentMap& map) {
  double sum = 0;
  for (int y = 0; y < map.height; ++y) {
    double row = 0;
    for (int x = 0; x < map.width; ++x) {
      const Vec3f& t = map.texels[ptrdiff_t{y} * map.width + x];
      row += std::max({t.x, t.y, t.z});
    }
    sum += row * TexelSolidAngle(map.width, map.height, y);
  }
  return sum / (4 * M_PI);
}

// An upper bound of what any material of the scene reflects of surroundings of radiance 1. Classic
// Phong materials lack the factor 1/pi, and their lobe, without n.l, integrates to 2 pi / (n + 1).
double MaxReflectance(const Scene& scene) {
  double largest = 1;
  for (const Material& material : scene.materials) {
    if (!IsClassic(material)) continue;
    const auto& phong = std::get<PhongMaterial>(material.model);
    const double exponent = phong.shininess_map.valid() ? 0 : phong.shininess;
    const Rgb matte = phong.color * phong.kd * M_PI, lobe = phong.ks * (2 * M_PI / (exponent + 1));
    const Rgb all = matte + lobe;
    largest = std::max(largest, LargestChannel(all));
  }
  return largest;
}

// An upper bound of the mean radiance that an object of reflectance 1 shows under the light. The
// image of a mirror ball shows all directions equally; a matte object shows at most 4 times their
// mean.
double BrightestUnder(const SampledLight& light) {
  const double color = LargestChannel(light.color);
  switch (light.form) {
    case SampledForm::kGradientSky:
    case SampledForm::kQuadraticSky:
      return kNoBound;
    case SampledForm::kPictureSky:
      return 4 * color * MeanRadiance(*light.sky.picture);
    default:
      return color;
  }
}

}  // namespace

double BrightestObject(const Scene& scene, const LightsPlan& lights, double white) {
  if (white < kNoBound) return white;
  for (const Material& material : scene.materials) {
    if (material.user) return kNoBound;  // it may gain energy
  }
  double brightest = LargestEmission(scene);
  for (const Light& light : scene.lights) {
    if (IsPunctual(light)) return kNoBound;
    if (const auto* ambient = std::get_if<AmbientLight>(&light.kind)) {
      brightest += LargestChannel(ambient->radiance);
    }
  }
  const double reflectance = MaxReflectance(scene);
  for (const PlannedSampledLight& light : lights.sampled) {
    brightest += reflectance * BrightestUnder(light.light);
  }
  return brightest;
}

}  // namespace nacre
