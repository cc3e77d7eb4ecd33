// SPDX-License-Identifier: Apache-2.0
// study/measures.h: numbers in the answers of the studies, each defined in the file of its study.
// Tests hold them to tables that other programs made.
#pragma once

#include <cstdint>

#include "base/image.h"
#include "scene/shapes.h"
#include "study/study.h"

namespace nacre {

// ---- Interpolation on meshes --------------------------------------------------------------------

// Errors against shading with the exact normal at the same points of the mesh; kd = 0.7, ks = 0.5,
// linear units.
struct InterpolationError {
  double diffuse_max = 0, diffuse_rms = 0;
  double specular_max = 0, specular_rms = 0;
  double specular_peak = 0;  // relative to ks
};

// Renders an icosphere of 20 * 4^subdivisions faces, seen from (0, 0, 1), lit from (2, 3, 3), with
// exponent 64, and with its diffuse and specular layers.
Image RenderIcosphere(Interpolation interpolation, int subdivisions, int pixels);

// `exact` is the same mesh with Phong interpolation, whose normals are those of the sphere.
InterpolationError MeasureInterpolation(const Image& image, const Image& exact);

// ---- Fresnel ------------------------------------------------------------------------------------

struct FresnelAngle {
  double cosine = 0, degrees = 0;
};

// For Schlick's curve: cos = 1 - ((F - F0) / (1 - F0))^(1/5), for F >= F0.
FresnelAngle SchlickAngle(double f0, double reflectance);

// For the exact curve of a dielectric with index eta > 1, which increases monotonically, by
// bisection; reflectance >= F0.
FresnelAngle DielectricAngle(double eta, double reflectance);

// The largest |Schlick - exact| over the cosine, and the cosine where it occurs; k = 0 is a
// dielectric.
struct FresnelGap {
  double difference = 0, cosine = 0;
};
FresnelGap LargestSchlickError(double eta, double k);

// ---- Energy of Phong's model --------------------------------------------------------------------

struct PhongCoefficients {
  double kd = 0.8, ks = 0.5, shininess = 64;
};

enum class PhongUnits : uint8_t {
  kLiteral,             // kd n.l + ks (r.v)^n, as lessons write it
  kOverPi,              // both terms over pi
  kModified,            // kd n.l + ks (r.v)^n n.l
  kModifiedOverPi,      // kModified divided by pi
  kModifiedNormalised,  // kd / pi and ks (n + 2) / 2 pi (Lafortune and Willems 1994)
};

// `cosine`: n.l > 0. Integrates the lobe by quadrature.
double PhongShare(const PhongCoefficients& phong, PhongUnits units, double cosine);

// ---- Tone and transfer curves -------------------------------------------------------------------

// The smallest radiance that ACES (Narkowicz) maps to white.
double AcesReachesWhite();

// The largest difference between x^(1/2.2) and the sRGB curve, and the linear value where it
// occurs.
struct GammaGap {
  double difference = 0, linear = 0;
};
GammaGap LargestGammaGap();

// ---- Layers -------------------------------------------------------------------------------------

// How finely the study of layers looks: walks of a surface at each angle and roughness, and numbers
// of roughnesses and angles, at least 2 each.
struct LayerEffort {
  int walks = 20000;
  int roughnesses = 6, angles = 9;
};
StudyResult StudyLayers(const LayerEffort& effort, const StudyProgress& progress);

}  // namespace nacre
