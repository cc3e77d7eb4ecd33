// SPDX-License-Identifier: Apache-2.0
// shading/lobe_fit.h: fits a lobe of one family to a material's lobe by least squares: the width is
// searched for, and the best strength of each channel for a width is computed exactly.
#pragma once

#include "scene/material.h"

namespace nacre {

struct FittedLobe {
  double width = 0;       // the exponent for the Phong family, alpha for GGX
  Rgb strength{0, 0, 0};  // ks (radiometric) or F0, each in [0, 1]
  double error = 0;       // the weighted sum of squared differences that was minimised
};

// Returns ks and shininess of a lobe of this model in radiometric units.
FittedLobe FitPhongLobe(const Material& original, PhongModel model);

// Returns F0 and alpha of a metallic-roughness lobe with the default options: Schlick's Fresnel
// curve, height-correlated shadowing and Turquin's compensation.
FittedLobe FitGgxLobe(const Material& original);

}  // namespace nacre
