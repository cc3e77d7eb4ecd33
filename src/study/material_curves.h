// SPDX-License-Identifier: Apache-2.0
// study/material_curves.h: plots the terms of reflection models as curves.
#pragma once

#include <string>
#include <vector>

#include "report/plot.h"
#include "shading/share.h"
#include "study/reflection.h"

namespace nacre {

// A material and its label in a plot.
struct NamedMaterial {
  std::string label;
  ShadingMaterial material;
};

// Which component of a colour is plotted.
enum class ColorChannel : uint8_t { kLuminance, kRed, kGreen, kBlue };
double ValueOf(const Rgb& rgb, ColorChannel channel);

struct CurveOptions {
  std::vector<double> angles_deg;  // of the direction that is fixed in a curve
  ColorChannel channel = ColorChannel::kLuminance;
  bool log = false;
  bool times_cosine = false;  // f n.l instead of f
  bool kernel = false;        // adds the results of the SIMD kernels
};

// f over the light's angle in the plane of incidence, for viewers at the given angles on the left.
Plot BrdfPlot(const std::vector<NamedMaterial>& materials, const CurveOptions& options);

// f n.l over the viewer's angle as a polar plot, for light from the given angles on the left.
Plot PolarPlot(const std::vector<NamedMaterial>& materials, const CurveOptions& options);

// The distribution D of the microfacet normals over their angle. Materials without one are skipped.
Plot DistributionPlot(const std::vector<NamedMaterial>& materials);
bool HasDistribution(const ShadingMaterial& material);

// G, the fraction of microfacets visible from both light and viewer, in the mirror configuration.
Plot MaskingPlot(const std::vector<NamedMaterial>& materials);
bool HasMasking(const ShadingMaterial& material);

// The Fresnel term over the angle of incidence.
Plot FresnelPlot(const std::vector<NamedMaterial>& materials, ColorChannel channel);
bool HasFresnel(const ShadingMaterial& material);

// The reflected fraction of light.
Plot AlbedoPlot(const std::vector<NamedMaterial>& materials, ShareOf what, ColorChannel channel);

}  // namespace nacre
