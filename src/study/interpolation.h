// SPDX-License-Identifier: Apache-2.0
// study/interpolation.h: how far spheres of faces are from the sphere, by what is interpolated.
#pragma once

#include "base/image.h"
#include "scene/shapes.h"

namespace nacre {

// Against the exact normal at the same points of the mesh; kd = 0.7, ks = 0.5, linear units.
struct InterpolationError {
  double diffuse_max = 0, diffuse_rms = 0;
  double specular_max = 0, specular_rms = 0;
  double specular_peak = 0;  // of ks
};

// An icosphere of 20 * 4^subdivisions faces, seen from (0, 0, 1), lit from (2, 3, 3), exponent 64,
// with its diffuse and specular layers.
Image RenderIcosphere(Interpolation interpolation, int subdivisions, int pixels);

// `exact` is the same mesh with Phong interpolation, whose normals are the sphere's.
InterpolationError MeasureInterpolation(const Image& image, const Image& exact);

}  // namespace nacre
