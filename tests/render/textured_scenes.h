// SPDX-License-Identifier: Apache-2.0
// tests/render/textured_scenes.h: small scenes with textures, and pictures that are equal to the
// bit.
#pragma once

#include <algorithm>
#include <functional>
#include <memory>

#include "catch.h"
#include "render/render.h"

namespace nacre {

inline ImageId AddImage(Scene* scene, MipChain chain, float middle = 128.0f / 255) {
  scene->images.push_back({"image", std::make_shared<const MipChain>(std::move(chain)), middle});
  return {static_cast<uint32_t>(scene->images.size() - 1)};
}

// A texture of spheres, width x height texels of `of(x, y)`.
inline TextureId AddTexture(Scene* scene, int width, int height,
                            const std::function<Rgb(int, int)>& of) {
  std::vector<float> values;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const Rgb value = of(x, y);
      for (int c = 0; c < 3; ++c) values.push_back(static_cast<float>(value[c]));
    }
  }
  Texture texture{.image = AddImage(scene, MakeMipChain(width, height, 3, std::move(values))),
                  .mapping = MappingKind::kSpherical};
  texture.sampling.wrap_v = Wrap::kClamp;
  scene->textures.push_back(texture);
  return {static_cast<uint32_t>(scene->textures.size() - 1)};
}

inline TextureId AddConstant(Scene* scene, const Rgb& value) {
  return AddTexture(scene, 8, 4, [&](int, int) { return value; });
}

// A value that a texel can hold.
inline double Held(double value) { return double{static_cast<float>(value)}; }
inline Rgb Held(const Rgb& value) { return {Held(value.x), Held(value.y), Held(value.z)}; }

// Three spheres of one material, one with the eye close to it and another behind it, under lights
// of every kind, with shadows.
inline Scene TexturedSpheres(const Material& material) {
  Scene scene;
  scene.image.width = 48;
  scene.image.height = 32;
  scene.image.spp = 4;
  scene.camera.position = Vec3d(0, 0, 6);
  scene.materials = {material};
  scene.spheres = {{{-0.9, 0, 0}, 0.8, {0}}, {{0.9, 0.2, 0.5}, 0.7, {0}}, {{0, 0, -3}, 2, {0}}};
  Light key;
  key.name = "key";
  key.kind = PointLight{.position = Vec3d(3, 4, 5), .intensity = Rgb(90, 80, 70)};
  Light sun;
  sun.name = "sun";
  DirectionalLight directional{.direction_of_travel = Vec3d(1, -1, -1),
                               .irradiance = Rgb(0.9, 1, 1.1)};
  sun.kind = directional;
  sun.shadows = false;
  Light lamp;
  lamp.name = "lamp";
  SpotLight spot{.position = Vec3d(-3, 0, 5),
                 .direction_of_travel = Vec3d(3, 0, -5),
                 .intensity = Rgb(50, 50, 60)};
  lamp.kind = spot;
  Light sky;
  sky.name = "sky";
  sky.kind = AmbientLight{Rgb(0.1, 0.2, 0.3)};
  scene.lights = {key, sun, lamp, sky};
  return scene;
}

inline Image AllLayers(const Scene& scene) {
  return RenderImage(scene, {.threads = 1, .layers = {"all"}});
}

inline void CheckSameBits(const Image& got, const Image& expected) {
  REQUIRE(got.channels.size() == expected.channels.size());
  for (size_t i = 0; i < got.channels.size(); ++i) {
    CAPTURE(expected.channels[i].name);
    const auto& a = got.channels[i].samples;
    const auto& b = expected.channels[i].samples;
    const auto [first, second] = std::mismatch(a.begin(), a.end(), b.begin(), b.end());
    const auto differing = first - a.begin();
    CHECK(first == a.end());
    if (first != a.end()) {
      CAPTURE(differing, *first, *second);
      CHECK(*first == *second);
    }
  }
}

}  // namespace nacre
