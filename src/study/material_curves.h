// SPDX-License-Identifier: Apache-2.0
// study/material_curves.h: plots the terms of reflection models as curves.
#pragma once

#include <string>
#include <vector>

#include "report/plot.h"
#include "scene/material.h"
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

// The Fresnel term over the angle of incidence.
Plot FresnelPlot(const std::vector<NamedMaterial>& materials, ColorChannel channel);

// Whether a material has what these two plots show; others are skipped.
bool HasMicrofacets(const ShadingMaterial& material);

// The reflected fraction of light.
Plot AlbedoPlot(const std::vector<NamedMaterial>& materials, ShareOf what, ColorChannel channel);

struct NamedLobe {
  std::string label;
  Material material;
};

// The specular lobes in the plane of incidence, a panel for each of kResidualViewsDeg: the
// luminance that the viewer sees for light from each angle. The range of angles is chosen by the
// first lobe's width, so that it falls off almost completely.
Figure LobeFigure(const std::vector<NamedLobe>& lobes);

// --- BRDFs as pictures of their most informative slice.

// The directions at a point of the slice: the half vector is `theta_h` from the normal, and the
// light `theta_d` from the half vector, at right angles to the plane of both (phi_d = 90 degrees;
// Rusinkiewicz 1998). If both angles are below 90 degrees, both directions are above the surface.
struct SliceDirections {
  Vec3d to_light, to_view;
};
SliceDirections DirectionsOfSlice(double theta_h_deg, double theta_d_deg);

// For each material, the BRDF over theta_h and theta_d as colours, on a common scale, which values
// for grazing light may exceed (Burley 2012, figure 3). The highlight is at the left, Fresnel's
// effect at the top, grazing retroreflection at the right.
std::vector<Plot> SlicePlots(const std::vector<NamedMaterial>& materials, ColorChannel channel);

}  // namespace nacre
