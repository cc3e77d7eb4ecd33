// SPDX-License-Identifier: Apache-2.0
// shading/log_fit.h: fits the main parameters of a model to any BRDF, of which only the values are
// known: to what was measured.
//
// Least squares of log(1 + f n.l), the metric of Low et al. 2012, "BRDF Models for Accurate and
// Efficient Rendering of Glossy Surfaces": without the logarithm, the peak of a highlight would
// count for nearly all, and nothing beside it. Pairs of directions are spread evenly over the
// square root of the half vector's angle, as cells of MERL tables are, and over viewers up to 75
// degrees; light beyond 80 degrees, where measurements are poor, does not count.
#pragma once

#include <span>
#include <string_view>

#include "scene/material.h"

namespace nacre {

// The parameters that are fitted of a model; empty if it is none of the targets.
std::span<const std::string_view> LogFitParameters(std::string_view model);

// The rms of the difference of both materials' log(1 + f n.l), over pairs of directions at which
// the original reflects light.
double LogResidual(const Material& original, const Material& other);

struct LogFit {
  Material guess;  // of the width of the lobe and the albedo alone
  Material fitted;
};

// Sets the model of `into` to that of this name, with parameters that are fitted to the original,
// and defaults else. LogFitParameters must have some.
LogFit FitLog(const Material& original, std::string_view model, const Material& into);

}  // namespace nacre
