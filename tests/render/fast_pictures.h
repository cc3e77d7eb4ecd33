// SPDX-License-Identifier: Apache-2.0
// tests/render/fast_pictures.h: what tests of lights in their fast mode share: a sphere, seen from
// +z, under one light, and pictures held beside the sampled truth.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "catch.h"
#include "light/environment.h"
#include "render/render.h"
#include "scene/scene.h"

namespace nacre {

using LightKind = decltype(Light::kind);

// Under no light yet.
inline Scene SphereFromAbove(decltype(Material::model) model, int side = 32) {
  Scene scene;
  scene.materials.emplace_back().model = std::move(model);
  scene.spheres.push_back({Vec3d(0, 0, 0), 1, {0}});
  scene.camera.projection = Projection::kOrthographic;
  scene.camera.height = 2.2;
  scene.image.width = scene.image.height = side;
  scene.image.spp = 1;
  return scene;
}

// Of metal.
inline Scene FastSphere(double roughness, LightKind light, bool fast = true) {
  Scene scene = SphereFromAbove(MetallicRoughnessMaterial{
      .base_color = Rgb(0.9, 0.6, 0.3), .metallic = 1, .roughness = roughness});
  Light& added = scene.lights.emplace_back();
  added.name = "lamp";
  added.fast = fast;
  added.kind = std::move(light);
  return scene;
}

inline EnvironmentMap MapOf(const SkyPicture& picture) {
  std::vector<Vec3f> texels;
  texels.reserve(picture.rgb.size() / 3);
  for (size_t i = 0; i < picture.rgb.size(); i += 3) {
    texels.emplace_back(picture.rgb[i], picture.rgb[i + 1], picture.rgb[i + 2]);
  }
  return MakeEnvironmentMap(picture.width, picture.height, texels);
}

// All lights in their fast mode.
inline RenderSettings Fast(std::vector<std::string> layers = {}) {
  RenderSettings settings;
  settings.fast_lights = true;
  settings.layers = std::move(layers);
  return settings;
}

inline Image RenderFast(const Scene& scene) {
  RenderSettings settings;
  settings.layers = {"specular", "diffuse"};
  return RenderImage(scene, settings);
}

inline double At(const Image& image, const std::string& channel, size_t i) {
  return image.Find(channel)->samples[i];
}

// Of the specular layer's red, over its mean, where `b` shows the highlight.
inline double RmsBetween(const Image& a, const Image& b) {
  const std::vector<float>& red = b.Find("specular.R")->samples;
  const double most = *std::max_element(red.begin(), red.end());
  double squares = 0, mean = 0, count = 0;
  for (size_t i = 0; i < a.data.pixel_count(); ++i) {
    if (At(a, "A", i) < 1 || At(b, "specular.R", i) < most / 4) continue;
    squares += std::pow(At(a, "specular.R", i) - At(b, "specular.R", i), 2);
    mean += At(b, "specular.R", i);
    count += 1;
  }
  return std::sqrt(squares / count) / (mean / count);
}

// Whether a light's transformed cosines are off from samples by about what the plan tells.
inline void CheckTold(const LightKind& light, double roughness) {
  const RenderPlan plan = MakePlan(FastSphere(roughness, light), {});
  REQUIRE(plan.fast_lights.size() == 1);
  const FastLight& told = plan.fast_lights[0];
  CHECK(told.light == "lamp");
  CHECK(told.method == "linearly transformed cosines");
  CHECK(told.points == 48);
  CHECK(told.rms > 1e-3);  // it is an approximation
  CHECK(told.rms < 0.25);
  Scene fast = FastSphere(roughness, light), sampled = FastSphere(roughness, light, false);
  CHECK(MakePlan(sampled, {}).fast_lights.empty());
  fast.image.spp = sampled.image.spp = 256;
  const double rms = RmsBetween(RenderFast(fast), RenderFast(sampled));
  CAPTURE(roughness, rms, told.rms, told.worst);
  // The picture has other points, all of one distance, and some noise.
  CHECK(rms <= 2 * told.rms + 0.02);
  CHECK(rms > 1e-4);
}

}  // namespace nacre
