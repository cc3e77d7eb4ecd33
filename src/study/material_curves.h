// SPDX-License-Identifier: Apache-2.0
// study/material_curves.h: what reflection models are made of, as curves.
#pragma once

#include <string>
#include <vector>

#include "report/plot.h"
#include "shading/share.h"
#include "study/reflection.h"

namespace nacre {

// One curve of a plot.
struct NamedMaterial {
  std::string label;
  ShadingMaterial material;
};

// Which number of a colour is drawn.
enum class ColorChannel : uint8_t { kLuminance, kRed, kGreen, kBlue };
double ValueOf(const Rgb& rgb, ColorChannel channel);

struct CurveOptions {
  std::vector<double> angles_deg;  // of the fixed direction
  ColorChannel channel = ColorChannel::kLuminance;
  bool log = false;
  bool times_cosine = false;  // f n.l instead of f
  bool kernel = false;        // also what the SIMD kernels make of it
};

// f over the light's angle in the plane of incidence, for viewers at these angles on the left.
Plot BrdfPlot(const std::vector<NamedMaterial>& materials, const CurveOptions& options);

// f n.l over the viewer's angle, as a lobe, for light that comes from these angles on the left.
Plot PolarPlot(const std::vector<NamedMaterial>& materials, const CurveOptions& options);

// The distribution D of the microfacets' normals over their angle, of those materials that have
// one.
Plot DistributionPlot(const std::vector<NamedMaterial>& materials);
bool HasDistribution(const ShadingMaterial& material);

// G, the share of microfacets that light and viewer both see, in the mirror configuration.
Plot MaskingPlot(const std::vector<NamedMaterial>& materials);
bool HasMasking(const ShadingMaterial& material);

// Fresnel's term over the angle of incidence.
Plot FresnelPlot(const std::vector<NamedMaterial>& materials, ColorChannel channel);
bool HasFresnel(const ShadingMaterial& material);

// The share of light that is reflected.
Plot AlbedoPlot(const std::vector<NamedMaterial>& materials, ShareOf what, ColorChannel channel);

}  // namespace nacre
