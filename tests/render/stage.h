// SPDX-License-Identifier: Apache-2.0
// tests/render/stage.h: a floor and a ball under lights of many kinds, for meshes that let some of
// the rays through.
#pragma once

#include <vector>

#include "pictures.h"
#include "scene/scene.h"

namespace nacre {

// A rectangle in the plane y = `height`, from (x0, z0) to (x1, z1); its front is
// above. u grows with x and v with z.
inline Mesh Sheet(double height, double x0, double x1, double z0, double z1, MaterialId material) {
  return {.positions = {{x0, height, z0}, {x1, height, z0}, {x1, height, z1}, {x0, height, z1}},
          .uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}},
          .triangles = {0, 2, 1, 0, 3, 2},
          .material = material};
}

// A floor and a ball on it, seen from above. What tests put over them is of material 1.
inline Scene StageScene(const std::vector<Light>& lights) {
  Scene scene;
  scene.image.width = 60;
  scene.image.height = 40;
  scene.image.spp = 4;
  scene.camera.position = Vec3d(0.31, 5.17, 6.23);
  scene.camera.look_at = Vec3d(0, 0.5, 0);
  scene.camera.fov_y_deg = 50;
  scene.background = Rgb(0.1, 0.2, 0.3);
  scene.materials.resize(2);
  scene.materials[0].model = LambertMaterial{Rgb(0.7)};
  scene.materials[1].model = LambertMaterial{Rgb(0.4, 0.5, 0.6)};
  scene.meshes = {Sheet(0, -4, 4, -4, 4, {0})};
  scene.spheres = {{Vec3d(0.5, 0.6, 0.3), 0.5, {0}}};
  scene.lights = lights;
  return scene;
}

// The lights that reach surfaces from above, one kind each.
inline std::vector<Light> LightsAbove() {
  PointLight point{.position = Vec3d(1, 5, 1.7), .intensity = Rgb(40)};
  RectangleAreaLight panel{.center = Vec3d(-1, 4, 0.4), .radiance = Rgb(5)};
  SphereAreaLight bulb{.center = Vec3d(2, 3.5, -1), .radius = 0.4, .radiance = Rgb(8)};
  EnvironmentLight sky;
  sky.sky = GradientSky{};
  return {Named("point", point), Named("sun", DirectionalLight{Vec3d(0.3, -1, 0.2), Rgb(2)}),
          Named("panel", panel), Named("bulb", bulb), Named("sky", sky)};
}

}  // namespace nacre
