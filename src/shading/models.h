// SPDX-License-Identifier: Apache-2.0
// shading/models.h: the constants of each reflection model, in double.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "brdf/albedo.h"
#include "brdf/anisotropic_albedo.h"
#include "brdf/ggx.h"
#include "brdf/measured_table.h"
#include "brdf/table_albedo.h"
#include "scene/model_options.h"
#include "scene/user_brdf.h"
#include "shading/constants.h"

namespace nacre {

// Below this roughness, and above this exponent, the half vector's terms are computed in double:
// a lobe of width alpha turns float's 6e-8 rad of direction into a relative error of about
// 1e-7 / alpha, 1e-5 at the limit of roughness. The limit of the exponent is where Phong's lobe,
// three widths out and on targets without fused multiply-add, is still within 2e-5 for the hits of
// tests/shading/highlight_test.cc. The choice depends on the material only, so a hit's bits never
// depend on what else is in its batch.
inline constexpr double kDoubleTermsRoughness = 0.1;
inline constexpr double kDoubleTermsShininess = 300;

// A diffuse surface: Lambert's, Oren-Nayar (EON) or Burley's.
struct MatteModel {
  template <class Number>
  using Constants = MatteConstants<Number>;
  template <class Number>
  using Light = MatteLight<Number>;
  DiffuseForm form = DiffuseForm::kLambert;
  Rgb diffuse;           // albedo / pi
  Rgb ratio{0, 0, 0};    // kOrenNayar: EonMultipleRatio of the albedo
  double roughness = 0;  // kOrenNayar and kBurley
};

struct PhongFamilyModel {
  template <class Number>
  using Constants = PhongConstants<Number>;
  template <class Number>
  using Light = PhongLight<Number>;
  PhongModel model;
  Rgb diffuse;   // kd color, over pi if radiometric
  Rgb specular;  // ks, times the lobe's normalisation if radiometric
  double shininess;
  bool double_terms;
};

enum class FresnelForm : uint8_t {
  kSchlick,
  kF82,
  kDielectric,
  kConductor,
  kOpenPbr,   // a mix of an exact dielectric, which a coat may cover, and of F82's metal
  kThinFilm,  // a mix of a dielectric and a metal under a film, each by a table
};

// Whether the dielectric's curve is Fresnel's own or a film's, whose albedo has a fit of its own.
inline bool HasExactCurve(FresnelForm fresnel) {
  return fresnel == FresnelForm::kDielectric || fresnel == FresnelForm::kOpenPbr ||
         fresnel == FresnelForm::kThinFilm;
}

// Whether MicrofacetModel's scales and cover are not all 1, so that kernels read them.
constexpr bool HasCover(FresnelForm fresnel) {
  return fresnel == FresnelForm::kOpenPbr || fresnel == FresnelForm::kThinFilm;
}

// The variant of a microfacet model.
struct MicrofacetForm {
  Shadowing shadowing;
  FresnelForm fresnel;
  Compensation compensation;
  DiffuseCoupling coupling;
  // kAlbedoScaled: whether the base's share depends on the directions of light and view alike,
  // which kTurquin does not allow.
  bool reciprocal = false;
  DiffuseForm base_form = DiffuseForm::kLambert;
};

// A GGX lobe that is wider along Surface::tangent than across it.
struct AnisotropicLobe {
  GgxAlphas<double> alpha;
  AnisotropicAlbedoFit albedo;
  // Of the dielectric's curve, if HasExactCurve: the first; under a film one of each channel.
  std::array<AnisotropicFresnelCurve, 3> fresnel;
};

// The anisotropic lobes of hits: one that they share, or one each.
struct AnisotropicLobes {
  const AnisotropicLobe* first = nullptr;  // null: the lobes are isotropic
  size_t stride = 0;                       // from the lobe of a hit to that of the next

  const AnisotropicLobe& At(size_t i) const { return first[i * stride]; }
};

// What a thin film makes of the Fresnel curves of dielectric and metal.
struct ThinFilmLobe {
  FresnelTable dielectric, metal;
  bool has_dielectric = true, has_metal = true;  // whether any hit reflects anything of it
  // The colours of the metal differ by hit: each has Schlick's curve through F0 (FilmedMetalAtHit).
  bool metal_by_hit = false;
  Rgb dielectric_average{0, 0, 0}, metal_average{0, 0, 0};  // 2 int F c dc
  double bend = 1;                                          // FittedFresnel
  // The albedo of the dielectric under isotropic lobes; and by all roughnesses, if hits have one
  // each.
  TableAlbedoFit albedo;
  TableAlbedoCurves curves;
};

// A GGX lobe over a diffuse base: metallic-roughness, conductor and dielectric.
//
// Metallic-roughness mixes two surfaces, as glTF 2.0 does (Appendix B.2): (1 - metallic) of a
// dielectric over a diffuse base, and metallic of a bare metal. Their lobes have the same
// distribution and visibility, so one lobe with the mix of their Fresnel curves is exactly the mix
// of their lobes. Terms that are not linear in the Fresnel curve are mixed themselves:
// compensation, and the base's share of the light, which only the dielectric above it reduces.
// Conductors are all metal, dielectrics all dielectric. OpenPBR mixes them likewise.
struct MicrofacetModel : MicrofacetForm {
  template <class Number>
  using Light = MicrofacetLight<Number>;
  // The base's albedo over pi, times 1 - metallic; where it is `reciprocal` also over the mean of 1
  // - the albedo of what covers the base.
  Rgb diffuse{0, 0, 0};
  double base_roughness = 0;  // for forms that are not Lambert's
  Rgb base_ratio{0, 0, 0};    // kOrenNayar: EonMultipleRatio of the base's colour
  double metallic = 0;        // the metal's share of the mix
  // Reflectance at normal incidence and, for Schlick's curve (and F82's), at grazing incidence,
  // where the metal's is 1.
  Rgb dielectric_f0{0, 0, 0};
  double dielectric_f90 = 1;
  Rgb metal_f0{0, 0, 0};
  Rgb f82_slope{0, 0, 0};        // kF82: for the metal
  Rgb eta{0, 0, 0}, k{0, 0, 0};  // kDielectric (eta only) and kConductor
  // kOpenPbr: the dielectric's curve. kOpenPbr and kThinFilm: factors on the reflection of
  // dielectric and metal; and the fraction of the dielectric's albedo that the base loses.
  CoatedDielectric<double> dielectric;
  Rgb dielectric_scale{1, 1, 1};
  double metal_scale = 1;
  Rgb cover{1, 1, 1};
  bool is_dielectric = false;  // no hit reflects anything of the metal
  Rgb f0{0, 0, 0};             // of the mix, as is f90
  double f90 = 1;
  // kKullaConty: the means of both Fresnel curves over the hemisphere; and the colour F_ms of the
  // second lobe, for the dielectric and for the mix.
  Rgb dielectric_f_average{0, 0, 0}, metal_f_average{0, 0, 0};
  Rgb dielectric_f_multiple{0, 0, 0}, f_multiple{0, 0, 0};
  std::shared_ptr<const ThinFilmLobe> film;  // kThinFilm; else null
  bool film_by_hit = false;  // F0 is that of a film, which differs by hit (FilmAtHit)
  double multiple = 0;       // kKullaConty: 1 / (pi (1 - E_avg)); 0 where nothing is lost
  double alpha;              // of the GGX lobe; of an anisotropic one the smaller
  double schlick_k;          // SchlickK
  bool delta;                // a perfect mirror, which punctual lights cannot show
  bool double_terms;
  bool prepared = false;    // shading needs PrepareRun
  FresnelAlbedoFit albedo;  // the exact Fresnel curve is set if kDielectric or kOpenPbr
  // kDielectric and kOpenPbr, if hits have a roughness each: the albedo curves for all roughnesses;
  // else null.
  std::shared_ptr<const DielectricCurves> curves;
  // Null for isotropic lobes. Where maps give hits alphas of their own, it has the maps' factors.
  std::shared_ptr<const AnisotropicLobe> anisotropic;
  // As `curves`, of anisotropic lobes: one, or under a film one of each channel.
  std::shared_ptr<const std::vector<AnisotropicFresnelCurves>> anisotropic_curves;
  MicrofacetConstants<float> constants;  // the numbers above, as kernels read them
};

// A model that the library's caller has written (user_model.h). `brdf` is not null.
struct UserModel {
  std::shared_ptr<const UserBrdf> brdf;
};

// A BRDF that was measured (measured_model.h). `brdf` is not null.
struct MeasuredModel {
  std::shared_ptr<const MeasuredBrdf> brdf;
  MeasuredInterpolation interpolation = MeasuredInterpolation::kLinear;
};

// Whether the terms of a lobe of this roughness are computed in double.
inline bool IsSharp(double roughness, double alpha) {
  return !IsDeltaLobe(alpha) && roughness < kDoubleTermsRoughness;
}

}  // namespace nacre
