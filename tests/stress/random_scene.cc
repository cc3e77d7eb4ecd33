// SPDX-License-Identifier: Apache-2.0
#include "stress/random_scene.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "stress/fuzz_draws.h"

namespace nacre {
namespace {

class Maker {
 public:
  explicit Maker(uint64_t seed) : random_(seed) {}

  Scene Make() {
    scene_.image.width = 32;
    scene_.image.height = 24;
    scene_.image.spp = 1;
    AddMaterials();
    AddSpheres();
    PlaceCamera();
    AddLights();
    ScaleAndMove();
    return std::move(scene_);
  }

 private:
  Rgb Color() {
    return {random_.Uniform(0.1, 0.9), random_.Uniform(0.1, 0.9), random_.Uniform(0.1, 0.9)};
  }

  void AddMaterials() {
    scene_.materials.resize(6);
    scene_.materials[0].model = LambertMaterial{Color()};
    for (size_t i = 1; i < 3; ++i) {
      scene_.materials[i].model =
          MetallicRoughnessMaterial{.base_color = Color(),
                                    .metallic = random_.OneIn(2) ? 0 : random_.Uniform(0, 1),
                                    .roughness = random_.Uniform(0.1, 1)};
    }
    for (size_t i = 3; i < 6; ++i) {
      scene_.materials[i].model = PhongMaterial{.model = static_cast<PhongModel>(i - 3),
                                                .color = Color(),
                                                .shininess = random_.Magnitude(1, 1e3)};
    }
    const char* names[] = {"lambert", "ggx 1", "ggx 2", "phong", "modified phong", "blinn-phong"};
    for (size_t i = 0; i < 6; ++i) scene_.materials[i].name = names[i];
  }

  void AddSphere(const Vec3d& center, double radius) {
    scene_.spheres.push_back({center, radius, {static_cast<uint32_t>(random_.Below(6))}});
  }

  // Within a few units of the origin.
  void AddSpheres() {
    const size_t count = 1 + random_.Below(8);
    for (size_t i = 0; i < count; ++i) {
      const Vec3d center = random_.Direction() * random_.Uniform(0, 2);
      const double radius = random_.OneIn(3) ? random_.Magnitude(1e-6, 1) : random_.Uniform(0.2, 1);
      AddSphere(center, radius);
      if (random_.OneIn(5)) AddSphere(center, radius);  // equal
      if (random_.OneIn(5))
        AddSphere(center, radius * (1 + random_.Magnitude(1e-7, 1e-2)));  // shell
      if (random_.OneIn(5)) {                                             // touching
        const double other = random_.Magnitude(1e-3, 1);
        AddSphere(center + random_.Direction() * (radius + other), other);
      }
    }
    if (random_.OneIn(3)) {
      const double radius = random_.Magnitude(10, 1e7);
      AddSphere({0, -radius - random_.Uniform(0, 2), 0}, radius);
    }
  }

  const Sphere& AnySphere() { return scene_.spheres[random_.Below(scene_.spheres.size())]; }

  // Looks at some sphere so that it fills about half of the picture, or at everything.
  void PlaceCamera() {
    Camera& camera = scene_.camera;
    const Sphere& subject = AnySphere();
    const double size = random_.OneIn(3) ? 2 : std::min(subject.radius, 3.0);
    const double distance = size * random_.Magnitude(1, 1e6);
    camera.look_at = subject.center + random_.Direction() * (subject.radius - size);
    camera.position = camera.look_at + random_.Direction() * distance;
    const double fov = 2 * std::atan(random_.Uniform(0.5, 3) * size / distance) * 180 / M_PI;
    camera.fov_y_deg = std::min(fov, 150.0);
    switch (random_.Below(8)) {
      case 0:  // inside
        camera.position =
            subject.center + random_.Direction() * (subject.radius * random_.Uniform(0, 0.99));
        camera.fov_y_deg = 100;
        break;
      case 1:  // just above a surface
        camera.position = subject.center +
                          random_.Direction() * (subject.radius * (1 + random_.Magnitude(1e-6, 1)));
        camera.fov_y_deg = 90;
        break;
      case 2:
        camera.projection = Projection::kOrthographic;
        camera.height = size * random_.Uniform(0.5, 4);
        break;
      default:
        break;
    }
    camera.look_at = camera.position +
                     (camera.look_at - camera.position).normalized() * std::max(distance, 1e-3);
    camera.up = random_.Direction();
  }

  // On, or just off, some sphere; or anywhere about.
  Vec3d LightPosition() {
    if (random_.OneIn(2)) return random_.Direction() * random_.Uniform(1, 6);
    const Sphere& sphere = AnySphere();
    return sphere.center + random_.Direction() * (sphere.radius * (1 + random_.Magnitude(1e-4, 3)));
  }

  void AddLights() {
    const size_t count = 1 + random_.Below(3);
    for (size_t i = 0; i < count; ++i) {
      Light light;
      light.name = "light " + std::to_string(i);
      const Rgb color = Color();
      switch (random_.Below(3)) {
        case 0:
          light.kind =
              DirectionalLight{.direction_of_travel = random_.Direction(), .irradiance = color};
          break;
        case 1:
          light.kind = PointLight{.position = LightPosition(), .intensity = color};
          break;
        default:
          light.kind = PointLight{.position = LightPosition(),
                                  .intensity = color,
                                  .attenuation = {1, random_.Uniform(0, 1), random_.Uniform(0, 1)}};
      }
      scene_.lights.push_back(std::move(light));
    }
  }

  // Attenuation other than by the square knows lengths: it scales along.
  void ScaleAndMove() {
    const double scale = random_.OneIn(2) ? 1 : random_.Magnitude(1e-6, 1e6);
    const Vec3d offset = random_.OneIn(2)
                             ? Vec3d(0, 0, 0)
                             : random_.Direction() * (scale * random_.Magnitude(1, 1e6));
    const auto place = [&](Vec3d* p) { *p = *p * scale + offset; };
    place(&scene_.camera.position);
    place(&scene_.camera.look_at);
    scene_.camera.height *= scale;
    for (Sphere& sphere : scene_.spheres) {
      place(&sphere.center);
      sphere.radius *= scale;
    }
    for (Light& light : scene_.lights) {
      if (auto* point = std::get_if<PointLight>(&light.kind)) {
        place(&point->position);
        point->attenuation.linear /= scale;
        point->attenuation.quadratic /= scale * scale;
      }
    }
  }

  FuzzRandom random_;
  Scene scene_;
};

}  // namespace

Scene MakeRandomScene(uint64_t seed) { return Maker(seed).Make(); }

}  // namespace nacre
