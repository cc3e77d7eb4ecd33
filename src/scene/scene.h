// SPDX-License-Identifier: Apache-2.0
// scene/scene.h: the one scene type: plain structs, a default for every field, references as typed
// handles. scene_io reads it, the generators make it, and the renderer plans from it. Ranges of all
// numbers: scene/limits.h.
//
// World space is right-handed, +y up. All positions and lengths are doubles in world units and stay
// as the file has them; everything in float later on is relative to the camera.
// Colours are linear Rec. 709. Those of directional lights are the irradiance of a surface that
// faces the light, those of point and spot lights radiant intensity, and those of all other lights
// and of the background radiance.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/vec.h"
#include "scene/camera.h"
#include "scene/light.h"
#include "scene/material.h"
#include "scene/shapes.h"
#include "scene/texture.h"

namespace nacre {

// Text that --labels writes into the PNG, beside the projection of a world point.
struct Label {
  enum class Side : uint8_t { kLeft, kAbove, kBelow };
  std::string text;
  Vec3d anchor;
  Side side = Side::kLeft;  // of the anchor
};

struct Scene {
  Camera camera;
  ImageSettings image;
  std::vector<SceneImage> images;
  std::vector<Texture> textures;
  std::vector<Material> materials;
  std::vector<Light> lights;
  std::vector<Sphere> spheres;
  std::vector<Mesh> meshes;
  std::vector<Label> labels;
  Rgb background{0, 0, 0};
};

}  // namespace nacre
