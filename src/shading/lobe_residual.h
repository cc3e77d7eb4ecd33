// SPDX-License-Identifier: Apache-2.0
// shading/lobe_residual.h: how far two materials differ: their specular lobes over the directions
// of light, and their albedos, at several views. By deterministic quadrature, without rendering.
#pragma once

#include <array>
#include <vector>

#include "scene/material.h"
#include "shading/scalar_bsdf.h"

namespace nacre {

// Angles between normal and viewer at which residuals are reported, one by one.
inline constexpr std::array<double, 4> kResidualViewsDeg = {0, 30, 60, 75};

// A view of a highlight on a sphere, and its weight.
struct HighlightView {
  double view_deg, weight;
};

// The views at which the viewer of a sphere sees highlights, for lights spread evenly over the
// hemisphere on the viewer's side. A light at the angle t from the viewer has its highlight where
// normal and viewer are t / 2 apart, so that the cosine of twice the view's angle is uniform in
// [0, 1]: four Gauss-Legendre points. Rims, which shine only under lights behind the sphere, do not
// count: the growth of Fresnel's term there, which Phong lacks, would otherwise decide the whole
// fit.
std::array<HighlightView, 4> HighlightViews();

// A direction of light and the solid angle that it stands for.
struct LobeSample {
  Vec3d to_light;
  double weight;
};

Vec3d ViewDirection(double view_deg);

// Directions distributed as a GGX lobe of this alpha, which also suits lobes a few times narrower
// or wider: 48 x 32 points of the half vector, on one side of the plane of incidence.
std::vector<LobeSample> MakeLobeSamples(double alpha, double view_deg);

// The alpha of the GGX lobe that is about as wide as the material's: 2 / alpha^2 - 2 is Blinn's
// exponent, and a fourth of that is Phong's. It is 1 if the material has no lobe.
double LobeAlpha(const Material& material);
double AlphaFromExponent(PhongModel model, double shininess);
double ExponentFromAlpha(PhongModel model, double alpha);

// The differences between a second lobe and a first one at one view, all channels together.
struct LobeResidual {
  double view_deg = 0;
  // The rms of the difference of BRDF n.l, over the rms of the first lobe's. Infinite where the
  // first material has no lobe and the second has one.
  double rms = 0;
  // The second highlight's peak and width over the first's, minus 1, in the plane of incidence. The
  // peak is the largest value, the width the angle of light between its halves. 0 where there is no
  // highlight to compare with.
  double peak = 0, width = 0;
  double albedo = 0;  // largest difference of a channel's directional albedo, diffuse and specular
};

struct MaterialResidual {
  std::vector<LobeResidual> views;
  double rms = 0;  // as LobeResidual::rms, but over all HighlightViews together
};

MaterialResidual MeasureResidual(const Material& original, const Material& other);

// The fraction of light from everywhere that is reflected diffusely, averaged over all views.
Rgb DiffuseAlbedo(const Material& material);

}  // namespace nacre
