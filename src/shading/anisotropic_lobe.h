// SPDX-License-Identifier: Apache-2.0
// shading/anisotropic_lobe.h: GGX lobes that are wider along Surface::tangent than across it: which
// materials have them, and their albedos in any direction.
#pragma once

#include <cmath>

#include "base/basis.h"
#include "brdf/ggx_anisotropic.h"
#include "scene/handle.h"
#include "shading/derive.h"
#include "shading/models.h"

namespace nacre {

struct Material;
struct MetallicRoughnessMaterial;
struct OpenPbrMaterial;

// Overloads for each model with such lobes. Anisotropic is also what with maps may be.
double AnisotropyOf(const MetallicRoughnessMaterial& material);
double AnisotropyOf(const OpenPbrMaterial& material);
template <class Model>
bool IsAnisotropic(const Model& material) {
  return AnisotropyOf(material) > 0;
}
bool IsAnisotropic(const Material& material);

// The alphas of a lobe of this roughness and anisotropy, by the model's own formula. Those of hits
// are MappedNumber::kWidth and kAnisotropy.
GgxAlphas<double> AlphasOf(const MetallicRoughnessMaterial& material, double roughness,
                           double anisotropy);
GgxAlphas<double> AlphasOf(const OpenPbrMaterial& material, double roughness, double anisotropy);
GgxAlphas<double> AlphasOf(const Material& material, double roughness, double anisotropy);

// The lobe of these alphas, which are those of `roughness`, under the model's shadowing and, if it
// is exact, its Fresnel curve.
AnisotropicLobe MakeAnisotropicLobe(const MicrofacetModel& model, const GgxAlphas<double>& alpha,
                                    double roughness);

// How a lobe lies in the frame of the texture coordinates.
struct TangentTurn {
  Rotation<double> rotation;
  TextureId direction;  // of MetallicRoughnessMaterial::anisotropy_map, which may be none
  // The map in whose coordinates the frame is; none: those of the shape itself.
  TextureId coordinates;
};
TangentTurn TangentTurnOf(const Material& material);

// A direction's cosines to a lobe's normal, tangent and bitangent. Isotropic lobes read only the
// first.
struct LobeCosines {
  double n, t, b;

  LobeCosines(double n_dot_x, double t_dot_x, double b_dot_x)
      : n(n_dot_x), t(t_dot_x), b(b_dot_x) {}
  // Of a direction that leans towards the tangent.
  LobeCosines(double n_dot_x)  // NOLINT(google-explicit-constructor)
      : n(n_dot_x), t(std::sqrt(std::max((1 - n_dot_x) * (1 + n_dot_x), 0.0))), b(0) {}
};

// Of x, in `frame`: tangent, bitangent and normal of the lobe.
inline LobeCosines CosinesTo(const Basis<double>& frame, const Vec3d& x) {
  const Vec3d local = frame.ToLocal(x);
  return {local.z, local.x, local.y};
}

// Directional albedos of single scattering: for F = 1, 1 minus that, and for Schlick's weight or,
// if HasExactCurve, for the dielectric's curve, of which all channels are alike but under films.
struct LobeAlbedos {
  double one, loss;
  Rgb curve;
};
LobeAlbedos AlbedosOfLobe(const MicrofacetModel& model, const AnisotropicLobe& lobe,
                          const LobeCosines& x);

// The means of these over the hemisphere, of a channel.
AlbedoAverages AveragesOf(const MicrofacetModel& model, const AnisotropicLobe& lobe, int channel);

}  // namespace nacre
