// SPDX-License-Identifier: Apache-2.0
#include "shading/anisotropic_lobe.h"

#include <variant>

#include "base/memo.h"
#include "base/overloaded.h"
#include "scene/material.h"

namespace nacre {

double AnisotropyOf(const MetallicRoughnessMaterial& material) { return material.anisotropy; }
double AnisotropyOf(const OpenPbrMaterial& material) {
  return material.specular_roughness_anisotropy;
}

bool IsAnisotropic(const Material& material) {
  return std::visit(
      Overloaded{[](const MetallicRoughnessMaterial& m) { return AnisotropyOf(m) > 0; },
                 [](const OpenPbrMaterial& m) { return AnisotropyOf(m) > 0; },
                 [](const MeasuredMaterial& m) { return m.brdf && !m.brdf->isotropic; },
                 [](const auto&) { return false; }},
      material.model);
}

GgxAlphas<double> AlphasOf(const MetallicRoughnessMaterial&, double roughness, double anisotropy) {
  return GltfAlphas(roughness, anisotropy);
}

GgxAlphas<double> AlphasOf(const OpenPbrMaterial& material, double roughness, double anisotropy) {
  return OpenPbrAlphas(roughness, anisotropy, material.options.alpha_max);
}

GgxAlphas<double> AlphasOf(const Material& material, double roughness, double anisotropy) {
  if (const auto* open_pbr = std::get_if<OpenPbrMaterial>(&material.model)) {
    return AlphasOf(*open_pbr, roughness, AnisotropyOf(*open_pbr));  // of which there is no map
  }
  return GltfAlphas(roughness, anisotropy);
}

namespace {

// What the fit of a dielectric's curve, or of a film's, depends on.
template <class Curve>
struct CurveFitKey {
  Shadowing shadowing;
  GgxAlphas<double> alpha;
  Curve curve;
  double bend;

  bool operator==(const CurveFitKey&) const = default;
};

// Fits are kept, as those of isotropic lobes are (material.cc).
AnisotropicFresnelCurve CurveFitOf(Shadowing shadowing, const GgxAlphas<double>& alpha,
                                   const CoatedDielectric<double>& curve) {
  static Memo<CurveFitKey<CoatedDielectric<double>>, AnisotropicFresnelCurve> memo;
  return *memo.Get({shadowing, alpha, curve, 0},
                   [&] { return MakeAnisotropicFresnelFit(shadowing, alpha, curve).fresnel; });
}

std::array<AnisotropicFresnelCurve, 3> AnisotropicTableFitOf(Shadowing shadowing,
                                                             const GgxAlphas<double>& alpha,
                                                             const FresnelTable& table,
                                                             double bend) {
  static Memo<CurveFitKey<FresnelTable>, std::array<AnisotropicFresnelCurve, 3>> memo;
  return *memo.Get({shadowing, alpha, table, bend},
                   [&] { return FitAnisotropicTable(shadowing, alpha, table, bend); });
}

}  // namespace

AnisotropicLobe MakeAnisotropicLobe(const MicrofacetModel& model, const GgxAlphas<double>& alpha,
                                    double roughness) {
  AnisotropicLobe lobe{alpha, MakeAnisotropicAlbedoFit(model.shadowing, alpha), {}};
  if (!HasExactCurve(model.fresnel)) return lobe;
  if (model.anisotropic_curves) {
    for (size_t c = 0; c < model.anisotropic_curves->size(); ++c) {
      lobe.fresnel[c] = BlendAnisotropicFresnelCurves((*model.anisotropic_curves)[c], roughness);
    }
  } else if (model.film) {
    lobe.fresnel =
        AnisotropicTableFitOf(model.shadowing, alpha, model.film->dielectric, model.film->bend);
  } else {
    lobe.fresnel[0] = CurveFitOf(model.shadowing, alpha, model.albedo.curve);
  }
  return lobe;
}

TangentTurn TangentTurnOf(const Material& material) {
  TangentTurn turn{{}, {}, material.normal_map.texture};
  if (const auto* metallic = std::get_if<MetallicRoughnessMaterial>(&material.model)) {
    turn.rotation = RotationOfDegrees(metallic->anisotropy_rotation_deg);
    turn.direction = metallic->anisotropy_map;
    if (!turn.coordinates.valid()) turn.coordinates = turn.direction;
  } else if (const auto* open_pbr = std::get_if<OpenPbrMaterial>(&material.model)) {
    turn.rotation = RotationOfDegrees(open_pbr->geometry_tangent_deg);
  }
  return turn;
}

LobeAlbedos AlbedosOfLobe(const MicrofacetModel& model, const AnisotropicLobe& lobe,
                          const LobeCosines& x) {
  const auto variables = ComputeAlbedoVariables(lobe.albedo.shape, x.n, x.t, x.b);
  const double loss = AlbedoLoss(lobe.albedo, variables), one = 1 - loss;
  if (!HasExactCurve(model.fresnel)) {
    return {one, loss, Rgb(AlbedoSchlick(lobe.albedo, one, variables))};
  }
  if (model.film) {
    return {one, loss,
            TableAlbedo(lobe.fresnel, lobe.albedo, model.film->dielectric, x.n, x.t, x.b)};
  }
  const double n = variables.n_dot_x;
  const double mirror = FresnelCoatedDielectric(n, 1 - n, model.albedo.curve);
  return {one, loss, Rgb(AlbedoFresnel(lobe.fresnel[0], one, mirror, variables))};
}

AlbedoAverages AveragesOf(const MicrofacetModel& model, const AnisotropicLobe& lobe, int channel) {
  const size_t curve = model.film ? static_cast<size_t>(channel) : 0;
  return {lobe.albedo.e_average, lobe.albedo.schlick_average, lobe.fresnel[curve].average};
}

}  // namespace nacre
