// SPDX-License-Identifier: Apache-2.0
// tests/stress/scale_test.cc: a picture does not know the unit of length, nor where the origin is.
#include <cmath>
#include <vector>

#include "catch.h"
#include "render/render.h"
#include "stress/everything.h"
#include "targets.h"

namespace nacre {
namespace {

// The scene in a unit `scale` times smaller. All lights with a place fall off with the square.
Scene Scaled(Scene scene, double scale) {
  scene.camera.position *= scale;
  scene.camera.look_at *= scale;
  for (Sphere& sphere : scene.spheres) {
    sphere.center *= scale;
    sphere.radius *= scale;
  }
  for (Mesh& mesh : scene.meshes) {
    for (Vec3d& position : mesh.positions) position *= scale;
  }
  for (Light& light : scene.lights) {
    if (auto* point = std::get_if<PointLight>(&light.kind)) {
      point->position *= scale;
      point->intensity *= scale * scale;
    } else if (auto* spot = std::get_if<SpotLight>(&light.kind)) {
      spot->position *= scale;
      spot->intensity *= scale * scale;
    }
  }
  return scene;
}

Scene Moved(Scene scene, const Vec3d& offset) {
  scene.camera.position += offset;
  scene.camera.look_at += offset;
  for (Sphere& sphere : scene.spheres) sphere.center += offset;
  for (Mesh& mesh : scene.meshes) {
    for (Vec3d& position : mesh.positions) position += offset;
  }
  for (Light& light : scene.lights) {
    if (auto* point = std::get_if<PointLight>(&light.kind)) {
      point->position += offset;
    } else if (auto* spot = std::get_if<SpotLight>(&light.kind)) {
      spot->position += offset;
    }
  }
  return scene;
}

Image Render(const Scene& scene) { return RenderImage(scene, {.layers = {"all"}}); }

// The far tails of lobes underflow sooner or later by what they are multiplied with first: at
// 2^-126, times what the intensity is then still to bring, here up to 150 and 2^40. Far below
// anything that shows.
constexpr float kTail = 0x1p-76f;

// How many samples differ, tails aside.
size_t CountApart(const std::vector<float>& a, const std::vector<float>& b) {
  REQUIRE(a.size() == b.size());
  size_t apart = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    const bool tails = std::abs(a[i]) < kTail && std::abs(b[i]) < kTail;
    if (a[i] == b[i] || tails) continue;
    if (apart++ == 0) UNSCOPED_INFO("first: sample " << i << ": " << a[i] << " and " << b[i]);
  }
  return apart;
}

bool IsLength(const Channel& channel) { return channel.name == "Z" || channel.name[0] == 'P'; }

TEST_CASE("scaling by a power of two changes no bit of a picture") {
  Scene scene = MakeEverything();
  AddMesh(&scene);
  ForEachTarget([&](Target) {
    const Image unscaled = Render(scene);
    for (const int exponent : {-20, -13, -1, 1, 8, 20}) {
      CAPTURE(exponent);
      const double scale = std::ldexp(1.0, exponent);
      const Image image = Render(Scaled(scene, scale));
      REQUIRE(image.channels.size() == unscaled.channels.size());
      for (size_t c = 0; c < image.channels.size(); ++c) {
        std::vector<float> expected = unscaled.channels[c].samples;
        if (IsLength(image.channels[c])) {
          for (float& value : expected) value *= static_cast<float>(scale);
        }
        CAPTURE(image.channels[c].name);
        CHECK(CountApart(expected, image.channels[c].samples) == 0);
      }
    }
  });
}

TEST_CASE("scaling by a power of ten changes a picture by rounding only") {
  Scene scene = MakeEverything();
  AddMesh(&scene);
  const Image unscaled = Render(scene);
  for (const double scale : {1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6}) {
    const Image image = Render(Scaled(scene, scale));
    for (size_t c = 0; c < image.channels.size(); ++c) {
      const double unit = IsLength(image.channels[c]) ? scale : 1;
      double worst = 0;
      for (size_t i = 0; i < image.channels[c].samples.size(); ++i) {
        const double got = image.channels[c].samples[i] / unit;
        const double expected = unscaled.channels[c].samples[i];
        worst = std::max(worst, std::abs(got - expected) / (0.1 + std::abs(expected)));
      }
      CAPTURE(scale, image.channels[c].name, worst);
      CHECK(worst <= 1e-4);
    }
  }
}

TEST_CASE("moving a scene by exact amounts changes no bit of a picture") {
  // Coordinates are multiples of 2^-16: those 2^36 away are still exact.
  Scene scene = MakeEverything();
  AddMesh(&scene);
  const Image unmoved = Render(scene);
  for (const Vec3d& offset : {Vec3d(1, 0, 0), Vec3d(1e6, -1e6, 5e5), Vec3d(-3e9, 6e10, 0x1p35)}) {
    CAPTURE(offset.x);
    const Image image = Render(Moved(scene, offset));
    for (size_t c = 0; c < image.channels.size(); ++c) {
      if (image.channels[c].name[0] == 'P') continue;
      CAPTURE(image.channels[c].name);
      CHECK(CountApart(image.channels[c].samples, unmoved.channels[c].samples) == 0);
    }
  }
}

}  // namespace
}  // namespace nacre
