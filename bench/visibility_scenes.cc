// SPDX-License-Identifier: Apache-2.0
#include "visibility_scenes.h"

#include "scene_io/load_scene.h"

namespace nacre {
namespace {

// A square grid of `side`^2 spheres that fills the height of the frame.
Scene MakeGrid(int side) {
  Scene scene;
  scene.camera.position = {0, 0, 10};
  scene.materials.emplace_back();
  const double spacing = 5.0 / side;
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column) {
      scene.spheres.push_back(
          {.center = {(column - (side - 1) / 2.0) * spacing, ((side - 1) / 2.0 - row) * spacing, 0},
           .radius = 0.4 * spacing,
           .material = {0}});
    }
  }
  return scene;
}

}  // namespace

const std::vector<SphereScene>& SphereScenes() {
  static const std::vector<SphereScene> kScenes = {
      {"grid", 0}, {"1e3", 32}, {"1e4", 100}, {"1e5", 316}};
  return kScenes;
}

Scene MakeSphereScene(const SphereScene& which) {
  if (which.side > 0) return MakeGrid(which.side);
  return LoadScene(std::string(NACRE_SOURCE_DIR) + "/scenes/material_grid.json", {});
}

}  // namespace nacre
