// SPDX-License-Identifier: Apache-2.0
// brdf/anisotropic_albedo_integral.h: directional albedos of the anisotropic GGX lobe by
// quadrature, in double: the reference to which the run-time fit (brdf/anisotropic_albedo.h) is
// fitted, and against which it is tested. No Monte Carlo.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "base/vec.h"
#include "brdf/fresnel_function.h"
#include "brdf/ggx_anisotropic.h"

namespace nacre {

inline constexpr int kFresnelPowers = 5;

// The albedos of one form of shadowing.
struct AnisotropicAlbedo {
  double loss = 0;                              // 1 - E of F = 1
  std::array<double, kFresnelPowers> powers{};  // for F = (1 - v.h)^1 to (1 - v.h)^5, Schlick's
  double fresnel = 0;                           // for the curve that was given, if any
};

// The resolution of the quadrature. Compared with a rule of several times as many points, over
// alphas in [1e-3, sqrt(2)], ratios in [1e-5, 1], all azimuths and n.v in [1e-8, 1], albedos of the
// default have errors of 4e-5 and take a tenth of a millisecond, those of the fine rule 1e-6.
// Losses have small errors relative to themselves, too, 6 % at worst, where they are far below
// 1e-5.
struct AnisotropicQuadrature {
  int rows = 28;         // Gauss-Legendre points across the lobe
  int points = 5;        // in each panel of a row
  int panels = 1;        // of rows
  double finest = 1e-2;  // the first panel at the light's horizon, as a part of half a row
};
inline constexpr AnisotropicQuadrature kFineAnisotropicQuadrature{32, 8, 2, 1e-3};
// For fits that are made at run time: errors of 6e-5 of Fresnel curves without total reflection, in
// half the time.
inline constexpr AnisotropicQuadrature kFastAnisotropicQuadrature{28, 3, 1, 5e-2};

// In the order of Shadowing: height-correlated and separable. `view` is unit, in the lobe's frame,
// with z in [0, 1], and the alphas are no delta lobe's.
std::array<AnisotropicAlbedo, 2> IntegrateAlbedos(const GgxAlphas<double>& alpha, const Vec3d& view,
                                                  const AnisotropicQuadrature& rule = {},
                                                  const FresnelFunction& fresnel = {});

// The quadrature of the limit alpha.y = 0, in which half vectors lie in the plane of normal and
// tangent, for a view in this plane. It depends on alpha.x and on kappa = alpha.x t.v / n.v. Other
// views of the same kappa have the same weights, in which v.h is multiplied by the length of their
// part in the plane.
struct StreakPoint {
  double v_dot_h, one_minus_vh;
  std::array<double, 2> weights;  // in the order of Shadowing; they sum to E
};
std::vector<StreakPoint> StreakQuadrature(double alpha_x, double kappa);

}  // namespace nacre
