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

}  // namespace

bool IsClassic(const Material& material) {
  const auto* phong = std::get_if<PhongMaterial>(&material.model);
  return phong != nullptr && phong->convention == PhongConvention::kClassic;
}

double LargestEmission(const Scene& scene) {
  double largest = 0;
  for (const Material& material : scene.materials) {
    double emission = LargestChannel(material.emission);
    if (emission > 0 && material.emission_map.valid()) {
      // Mip levels are means, and so no larger.
      const ImageId image = scene.textures[material.emission_map.index].image;
      emission *= double{scene.images[image.index].texels->greatest};
    }
    largest = std::max(largest, emission);
  }
  return largest;
}

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

}  // namespace nacre
