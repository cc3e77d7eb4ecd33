// SPDX-License-Identifier: Apache-2.0
// scene/camera.h: the camera and the settings of its image.
#pragma once

#include <cstdint>

#include "base/vec.h"
#include "sampling/pixel_filter.h"

namespace nacre {

enum class Projection : uint8_t { kPerspective, kOrthographic };

struct Camera {
  Projection projection = Projection::kPerspective;
  Vec3d position{0, 0, 10};
  Vec3d look_at{0, 0, 0};
  Vec3d up{0, 1, 0};
  double fov_y_deg = 30;  // perspective: full vertical field of view, in (0, 180)
  double height = 2;      // orthographic: height of the view in world units, > 0
};

struct ImageSettings {
  int width = 1280;  // in [1, 65536]
  int height = 720;  // in [1, 65536]
  int spp = 16;      // samples per pixel, in [1, 65536]; 1 is the pixel's centre
  PixelFilter filter;
  uint32_t seed = 0;    // seeds the sample pattern
  bool shadows = true;  // false: no light casts shadows
  bool culling = true;  // false: single-sided materials (Material::single_sided) have a back, too
  friend bool operator==(const ImageSettings&, const ImageSettings&) = default;
};

}  // namespace nacre
