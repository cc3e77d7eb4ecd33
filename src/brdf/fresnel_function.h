// SPDX-License-Identifier: Apache-2.0
// brdf/fresnel_function.h: a Fresnel curve as quadratures are given it.
#pragma once

#include <functional>

namespace nacre {

// The reflectance at the cosine v.h. It is also given 1 - v.h, which may be too small to survive a
// subtraction.
using FresnelFunction = std::function<double(double v_dot_h, double one_minus_vh)>;

}  // namespace nacre
