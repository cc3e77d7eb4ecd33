// SPDX-License-Identifier: Apache-2.0
#include "render/white_level.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>
#include <vector>

#include <Imath/ImathBoxAlgo.h>

#include "base/overloaded.h"

namespace nacre {
namespace {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

// The distance of a light is computed for at most this many spheres.
constexpr size_t kMaxMeasuredSpheres = 4096;

double LeastDistance(const Scene& scene, const std::vector<Imath::Box3d>& meshes,
                     const Vec3d& place) {
  double least = kNoLimit;
  const size_t step = scene.spheres.size() / kMaxMeasuredSpheres + 1;
  for (size_t i = 0; i < scene.spheres.size(); i += step) {
    const Sphere& sphere = scene.spheres[i];
    least = std::min(least, std::abs((place - sphere.center).length() - sphere.radius));
  }
  for (const Imath::Box3d& mesh : meshes) {
    least = std::min(least, (place - Imath::closestPointInBox(place, mesh)).length());
  }
  return least;
}

// Whether a material has the classic convention, which leaves out the factor 1/pi.
bool IsClassic(const Material& material) {
  const auto* phong = std::get_if<PhongMaterial>(&material.model);
  return phong != nullptr && phong->convention == PhongConvention::kClassic;
}

// The largest radiance, in any channel, that a material of the scene emits, with its map.
double LargestEmission(const Scene& scene) {
  double largest = 0;
  for (const Material& material : scene.materials) {
    double emission = LargestChannel(EmissionOf(material));
    if (emission > 0 && material.emission_map.valid()) {
      // Mip levels are means, and so no larger.
      const ImageId image = scene.textures[material.emission_map.index].image;
      emission *= double{scene.images[image.index].texels->greatest};
    }
    largest = std::max(largest, emission);
  }
  return largest;
}

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
      return kNoLimit;
    case SampledForm::kPictureSky:
      return 4 * color * MeanRadiance(*light.sky.picture);
    default:
      return color;
  }
}

}  // namespace

double WhiteLevel(const Scene& scene) {
  std::vector<Imath::Box3d> meshes(scene.meshes.size());
  for (size_t i = 0; i < meshes.size(); ++i) {
    for (const Vec3d& position : scene.meshes[i].positions) meshes[i].extendBy(position);
  }
  // Without shapes the distance is infinite, and the irradiance 0.
  const auto irradiance = [&](const auto& light) {
    const double d = LeastDistance(scene, meshes, light.position);
    const Attenuation& a = light.attenuation;
    const double falloff = (a.quadratic * d + a.linear) * d + a.constant;
    const double intensity = LargestChannel(light.intensity);
    return intensity == 0 || d == kNoLimit ? 0 : intensity / falloff;
  };
  const bool classic = std::any_of(scene.materials.begin(), scene.materials.end(), IsClassic);
  const double of_irradiance = classic ? 1 : 1 / M_PI;
  double white = 0;
  for (const Light& light : scene.lights) {
    white += std::visit(
        Overloaded{
            [](const AmbientLight& l) { return LargestChannel(l.radiance); },
            [&](const DirectionalLight& l) { return of_irradiance * LargestChannel(l.irradiance); },
            [&](const PointLight& l) { return of_irradiance * irradiance(l); },
            [&](const SpotLight& l) { return of_irradiance * irradiance(l); },
            [](const auto&) { return kNoLimit; }},
        light.kind);
  }
  if (white == kNoLimit) return white;
  return std::max({white, LargestChannel(scene.background), LargestEmission(scene)});
}

double BrightestObject(const Scene& scene, const LightsPlan& lights, double white) {
  if (white < kNoLimit) return white;
  for (const Material& material : scene.materials) {
    if (material.user) return kNoLimit;  // it may gain energy
  }
  double brightest = LargestEmission(scene);
  for (const Light& light : scene.lights) {
    if (IsPunctual(light)) return kNoLimit;
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
