// SPDX-License-Identifier: Apache-2.0
// study/interpolation.h: the shading error of sphere meshes, depending on what is interpolated.
#pragma once

#include "base/image.h"
#include "scene/shapes.h"

namespace nacre {

// Errors against shading with the exact normal at the same points of the mesh; kd = 0.7, ks = 0.5,
// linear units.
struct InterpolationError {
  double diffuse_max = 0, diffuse_rms = 0;
  double specular_max = 0, specular_rms = 0;
  double specular_peak = 0;  // relative to ks
};

// Renders an icosphere of 20 * 4^subdivisions faces, seen from (0, 0, 1), lit from (2, 3, 3), with
// exponent 64, and with its diffuse and specular layers.
Image RenderIcosphere(Interpolation interpolation, int subdivisions, int pixels);

// `exact` is the same mesh with Phong interpolation, whose normals are those of the sphere.
InterpolationError MeasureInterpolation(const Image& image, const Image& exact);

}  // namespace nacre
