// SPDX-License-Identifier: Apache-2.0
// shading/lobe_fit.h: the lobe of one family that is nearest to a material's, by least squares:
// the width by search, the strength of each channel for that width exactly.
#pragma once

#include "scene/material.h"

namespace nacre {

struct FittedLobe {
  double width = 0;       // of Phong's family the exponent, of GGX alpha
  Rgb strength{0, 0, 0};  // ks (radiometric), or F0; each in [0, 1]
  double error = 0;       // what the search made small
};

// ks and shininess of a lobe of this model in radiometric units.
FittedLobe FitPhongLobe(const Material& original, PhongModel model);

// F0 and alpha of a metallic-roughness lobe with Schlick's Fresnel, height-correlated and
// compensated as Turquin has it: the defaults.
FittedLobe FitGgxLobe(const Material& original);

}  // namespace nacre
