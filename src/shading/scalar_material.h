// shading/scalar_material.h: what a prepared material reflects, in double, for one light and one
// viewer: for measuring materials, not for rendering. The kernels compute the same.
#pragma once

#include "shading/material.h"

namespace nacre {

// Radiance towards the viewer per irradiance of the light on a surface facing it: BRDF times n.l.
struct Response {
  Rgb diffuse{0, 0, 0}, specular{0, 0, 0};
};

// Directions in a frame whose normal is +z; 0 where either lies below. A delta lobe shows nothing;
// neither do emission, ambient light and maps.
Response EvaluateResponse(const ShadingMaterial& material, const Vec3d& to_light,
                          const Vec3d& to_view);

}  // namespace nacre
