// SPDX-License-Identifier: Apache-2.0
// shading/material_fit.h: a material of one reflection model as the nearest one of another:
// Phong family <-> metallic-roughness and dielectric. The closed forms that books give
// (n = 2 / alpha^2 - 2 for Blinn's lobe, a fourth of it for Phong's) are where a fit starts.
//
// The lobe is fitted by least squares over the directions of light at HighlightViews(); the base
// keeps its mean albedo. What the other model cannot say is told in words.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scene/material.h"
#include "shading/lobe_residual.h"

namespace nacre {

struct MaterialFit {
  Material guess;  // by the closed forms
  Material fitted;
  MaterialResidual guess_residual, residual;
  std::vector<std::string> notes;  // what is lost
};

// Names of the models that FitMaterial makes.
std::span<const std::string_view> FitTargets();

// `target` is one of FitTargets(). Throws Error (kBadInput) for a split, which is no one material.
MaterialFit FitMaterial(const Material& original, std::string_view target);

}  // namespace nacre
