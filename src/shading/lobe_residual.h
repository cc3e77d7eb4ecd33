// SPDX-License-Identifier: Apache-2.0
// shading/lobe_residual.h: how far two materials are apart: their specular lobes over the
// directions of light, and their albedos, at several views. Deterministic quadrature, no picture.
#pragma once

#include <array>
#include <vector>

#include "scene/material.h"
#include "shading/scalar_material.h"

namespace nacre {

// Angles between normal and viewer at which lobes are compared.
inline constexpr std::array<double, 4> kResidualViewsDeg = {0, 30, 60, 75};

// A direction of light and the solid angle that it stands for.
struct LobeSample {
  Vec3d to_light;
  double weight;
};

Vec3d ViewDirection(double view_deg);

// How much a view counts: n.v, the share that it has of the disc that a sphere is seen as.
double ViewWeight(double view_deg);

// Directions as dense as a GGX lobe of this alpha, which also suits lobes a few times narrower or
// wider: 48 x 32 points of the half vector, on one side of the plane of incidence.
std::vector<LobeSample> MakeLobeSamples(double alpha, double view_deg);

// The alpha of the GGX lobe that is about as wide as the material's: 2 / alpha^2 - 2 is Blinn's
// exponent, and a fourth of that Phong's. 1 if it has no lobe.
double LobeAlpha(const Material& material);
double AlphaFromExponent(PhongModel model, double shininess);
double ExponentFromAlpha(PhongModel model, double alpha);

// Of a lobe in place of another; all channels together.
struct LobeResidual {
  double view_deg = 0;
  // Of the difference of BRDF n.l, over the rms of the first lobe's: infinite where that has none
  // and the second has.
  double rms = 0;
  double peak = 0;    // the second lobe's largest value over the first's, minus 1
  double albedo = 0;  // largest difference of a channel's directional albedo, diffuse and specular
};

struct MaterialResidual {
  std::vector<LobeResidual> views;
  double rms = 0;  // root of the mean square over the views, weighted by ViewWeight
};

MaterialResidual MeasureResidual(const Material& original, const Material& other);

// The part of light from everywhere that is reflected diffusely, averaged over all views.
Rgb DiffuseAlbedo(const Material& material);

}  // namespace nacre
