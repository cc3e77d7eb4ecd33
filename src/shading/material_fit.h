// SPDX-License-Identifier: Apache-2.0
// shading/material_fit.h: converts a material of one reflection model to the nearest one of
// another: Phong family <-> metallic-roughness and dielectric; and any, also a measured one, to
// OpenPBR. A fit starts from the closed forms that books give (n = 2 / alpha^2 - 2 for Blinn's
// lobe, a fourth of it for Phong's).
//
// The lobe is fitted by least squares over the directions of light at HighlightViews(); the base
// keeps its mean albedo. What the other model cannot express is noted in words. Of a measured
// material, which does not tell lobe and base apart, and for OpenPBR, log_fit.h fits all main
// parameters at once.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scene/material.h"
#include "shading/lobe_residual.h"

namespace nacre {

struct MaterialFit {
  Material guess;  // by the closed forms alone
  Material fitted;
  MaterialResidual guess_residual, residual;
  std::vector<std::string> notes;  // what the conversion loses, for users
  // LogResidual of both, where the fit is that of log_fit.h; else below 0.
  double guess_log_rms = -1, log_rms = -1;
};

// The names of the models to which FitMaterial converts.
std::span<const std::string_view> FitTargets();

// `target` is one of FitTargets(). Throws Error (kBadInput) for a split, which is not one material.
MaterialFit FitMaterial(const Material& original, std::string_view target);

}  // namespace nacre
