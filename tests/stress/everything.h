// SPDX-License-Identifier: Apache-2.0
// tests/stress/everything.h: a scene with every reflection model, each of its options, every kind
// of light, and shadows.
#pragma once

#include <cmath>
#include <string>
#include <utility>

#include "scene/material_parameters.h"
#include "scene/scene.h"

namespace nacre {

// A material of every model with every one of its options, coloured.
inline std::vector<Material> EveryMaterial() {
  std::vector<Material> materials;
  const auto add = [&](const MaterialModel& model) -> Material& {
    materials.push_back(model.make());
    for (const MaterialParameter& parameter : model.parameters) {
      if (parameter.is_color && parameter.name != "emission") {
        parameter.set(materials.back(), Rgb(0.8, 0.5, 0.2));
      }
    }
    return materials.back();
  };
  for (const MaterialModel& model : MaterialModels()) {
    add(model);
    for (const MaterialChoice& choice : model.choices) {
      for (size_t option = 1; option < choice.options.size(); ++option) {
        choice.set(add(model), option);
      }
    }
    if (const MaterialParameter* metallic = FindParameter(model, "metallic")) {
      metallic->set(add(model), Rgb(1, 1, 1));
    }
  }
  return materials;
}

// Spheres of all materials in two rows on a ground; coordinates are multiples of 2^-16, so that
// moving the scene by whole numbers is exact.
inline Scene MakeEverything() {
  Scene scene;
  scene.image.width = 192;
  scene.image.height = 108;
  scene.image.spp = 1;
  scene.camera.position = {0.5, 2.25, 9};
  scene.camera.look_at = {0, 0.5, 0};
  scene.background = {0.05, 0.06, 0.1};
  scene.materials = EveryMaterial();
  const size_t count = scene.materials.size();
  for (size_t i = 0; i < count; ++i) {
    const double x =
        (static_cast<double>(i / 2) - static_cast<double>((count - 1) / 2) / 2) * 1.125;
    const Vec3d center(x, i % 2 == 0 ? 0.5 : 1.625, i % 2 == 0 ? 0.75 : -0.5);
    scene.spheres.push_back({center, 0.53125, {static_cast<uint32_t>(i)}});
  }
  scene.spheres.push_back({{0, -1000, 0}, 1000, {0}});
  const auto add = [&](const std::string& name, auto kind) {
    scene.lights.push_back(Light{.name = name, .kind = std::move(kind)});
  };
  add("key", PointLight{.position = {3, 5, 6}, .intensity = {90, 85, 80}});
  add("sun", DirectionalLight{.direction_of_travel = {1, -1, -0.5}, .irradiance = {0.5, 0.6, 0.7}});
  add("spot", SpotLight{.position = {-3, 5, 3},
                        .direction_of_travel = {3, -5, -3},
                        .intensity = {150, 150, 150},
                        .cutoff_deg = 25,
                        .inner_deg = 15,
                        .exponent = 2});
  add("sky", AmbientLight{{0.1, 0.1, 0.12}});
  return scene;
}

// A mesh in front of the spheres, for tests that need no truth.
inline void AddMesh(Scene* scene) {
  Mesh mesh{.positions = {{-3, 0.125, 2}, {-1.5, 0.125, 2.5}, {-2.25, 1.5, 1.875}, {-1, 1.25, 2}},
            .triangles = {0, 1, 2, 1, 3, 2},
            .material = {0}};
  scene->meshes.push_back(mesh);
}

}  // namespace nacre
