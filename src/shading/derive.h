// SPDX-License-Identifier: Apache-2.0
// shading/derive.h: from the parameters of a material to the constants of its model, in double.
//
// There is one function for each step. It is called once per material (material.cc) and, where maps
// give hits parameters of their own, at each hit (mapped_kernel.cc): a map that is constant gives
// the same bits as the constant. The functions are inline and without branches on their arguments,
// so that the compiler vectorises the loops over hits.
#pragma once

#include <cmath>

#include "base/vec.h"
#include "brdf/albedo.h"
#include "brdf/eon.h"
#include "brdf/fresnel.h"
#include "brdf/ggx.h"
#include "brdf/multi_scatter.h"
#include "brdf/phong.h"
#include "scene/open_pbr.h"
#include "shading/constants.h"
#include "shading/models.h"

#if defined(__GNUC__)
#define NACRE_DERIVE inline __attribute__((always_inline))
#else
#define NACRE_DERIVE inline
#endif

namespace nacre {

// --- Diffuse surfaces and bases, for one channel. ---

// The BRDF of a Lambertian surface: albedo / pi.
NACRE_DERIVE double DeriveDiffuse(double albedo) { return albedo * M_1_PI; }

// --- The Phong family. ---

// The scale of the lobe by the material's convention.
inline double DerivePhongScale(PhongModel model, PhongConvention convention, double shininess) {
  if (convention == PhongConvention::kClassic) return 1;
  return model == PhongModel::kBlinnPhong ? BlinnNormalization(shininess)
                                          : PhongNormalization(shininess);
}

// One channel of a Phong material.
struct PhongChannel {
  double diffuse, specular;
};
NACRE_DERIVE PhongChannel DerivePhong(PhongConvention convention, double kd, double color,
                                      double ks, double scale) {
  const double over_pi = convention == PhongConvention::kRadiometric ? M_1_PI : 1;
  return {kd * color * over_pi, ks * scale};
}

// --- Microfacet models. ---

// Constants that follow from the roughness of a lobe.
struct LobeWidth {
  double alpha;
  bool delta;
  double shown_alpha;  // alpha, but 1 for a delta lobe
  double schlick_k;    // SchlickK
  double sharp_alpha;  // alpha if the lobe's terms are computed in double, else -1
};
NACRE_DERIVE LobeWidth DeriveWidth(Shadowing shadowing, double roughness) {
  const double alpha = AlphaFromRoughness(roughness);
  const bool delta = IsDeltaLobe(alpha);
  return {.alpha = alpha,
          .delta = delta,
          .shown_alpha = delta ? 1 : alpha,
          .schlick_k = SchlickK(shadowing, roughness),
          .sharp_alpha = IsSharp(roughness, alpha) ? alpha : -1};
}

NACRE_DERIVE LobeWidth DeriveWidth(const GgxAlphas<double>& alpha) {
  const bool delta = IsDeltaLobe(alpha);
  const double narrow = std::min(alpha.x, alpha.y);
  return {.alpha = narrow,
          .delta = delta,
          .shown_alpha = delta ? 1 : std::sqrt(alpha.x * alpha.y),
          .schlick_k = 0,
          .sharp_alpha = narrow};
}

// One channel of the colours of a microfacet material: the base's colour and BRDF, and the Fresnel
// curves of dielectric and metal.
struct MicrofacetColors {
  double base_color;
  double diffuse;  // base_color / pi, times 1 - metallic
  double metallic;
  double dielectric_f0, dielectric_f90;
  double metal_f0, f82_slope;
  // OpenPBR: as in MicrofacetModel.
  double dielectric_scale = 1, metal_scale = 1, cover = 1;
};

NACRE_DERIVE MicrofacetColors DeriveMetallicRoughness(double base_color, double metallic,
                                                      double dielectric_f0, double specular,
                                                      double f82_tint) {
  return {.base_color = base_color,
          .diffuse = base_color * ((1 - metallic) * M_1_PI),
          .metallic = metallic,
          .dielectric_f0 = dielectric_f0 * specular,
          .dielectric_f90 = specular,
          .metal_f0 = base_color,
          .f82_slope = F82SlopeFromTint(base_color, f82_tint)};
}

// f0 is FresnelF0 of the material's index of refraction.
NACRE_DERIVE MicrofacetColors DeriveConductor(double f0, double f82_slope) {
  return {.base_color = 0,
          .diffuse = 0,
          .metallic = 1,
          .dielectric_f0 = 0,
          .dielectric_f90 = 1,
          .metal_f0 = f0,
          .f82_slope = f82_slope};
}

NACRE_DERIVE MicrofacetColors DeriveDielectric(double base_color, double f0) {
  return {.base_color = base_color,
          .diffuse = DeriveDiffuse(base_color),
          .metallic = 0,
          .dielectric_f0 = f0,
          .dielectric_f90 = 1,
          .metal_f0 = 0,
          .f82_slope = 0};
}

// One channel of an OpenPBR material, with what may vary by hit. `f0` is the value at normal
// incidence of the dielectric's curve.
struct OpenPbrChannel {
  double base_color, metalness, subsurface_color;
  double specular_color, largest_specular_color;  // of this channel, and of all
};
// The colour of a diffuse base of which a subsurface is a share: its light comes out where it went
// in.
NACRE_DERIVE double DeriveDiffuseBase(double base_color, double subsurface_color, double weight) {
  return base_color + (subsurface_color - base_color) * weight;
}
NACRE_DERIVE MicrofacetColors DeriveOpenPbr(const OpenPbrMaterial& material,
                                            const OpenPbrChannel& at, double f0) {
  const OpenPbrOptions& options = material.options;
  const double of_metal = material.base_weight * at.base_color;
  const double base_color =
      DeriveDiffuseBase(of_metal, at.subsurface_color, material.subsurface_weight);
  const double weight = std::min(material.specular_weight, 1.0);
  const double factor = options.specular_weight_rule == SpecularWeightRule::kFactor ? weight : 1;
  const double tint_below =
      options.specular_tint_below == SpecularTintBelow::kComplementary ? at.specular_color
      : options.specular_tint_below == SpecularTintBelow::kMaxChannel  ? at.largest_specular_color
                                                                       : 1;
  return {.base_color = base_color,
          .diffuse = base_color * ((1 - at.metalness) * M_1_PI),
          .metallic = at.metalness,
          .dielectric_f0 = f0,
          .dielectric_f90 = 1,
          .metal_f0 = of_metal,
          .f82_slope = F82SlopeFromTint(of_metal, at.specular_color),
          .dielectric_scale = at.specular_color * factor,
          .metal_scale = weight,
          .cover = tint_below * factor};
}

// The colours under a thin film, whose reflectances at normal incidence are given. KHR_materials_
// specular's factor, which F90 is without film, scales all that the dielectric reflects.
NACRE_DERIVE MicrofacetColors DeriveUnderFilm(MicrofacetColors at, double dielectric_f0,
                                              double metal_f0) {
  at.dielectric_scale *= at.dielectric_f90;
  at.cover *= at.dielectric_f90;
  at.dielectric_f90 = 1;
  at.dielectric_f0 = dielectric_f0;
  at.metal_f0 = metal_f0;
  return at;
}

// The colours where a film covers `share` of the surface, as Schlick's curves through its F0.
NACRE_DERIVE MicrofacetColors DeriveFilmedAtHit(MicrofacetColors at, double share,
                                                double dielectric_f0, double metal_f0) {
  at.dielectric_f0 += (dielectric_f0 * at.dielectric_f90 - at.dielectric_f0) * share;
  at.metal_f0 += (metal_f0 - at.metal_f0) * share;
  at.f82_slope *= 1 - share;
  return at;
}

// F90 of the mix, in a form that is exactly 1 for the default dielectric_f90 of 1.
NACRE_DERIVE double MixedF90(double dielectric_f90, double metallic) {
  return 1 - (1 - dielectric_f90) * (1 - metallic);
}

// One channel of the mix of both Fresnel curves: the reflectance at normal incidence and, for
// Turquin's compensation of Schlick's curve, the mix of F0 F of both at normal and at grazing
// incidence (TurquinTerm).
struct MixedCurve {
  double f0, turquin_f0, turquin_f90;
};
NACRE_DERIVE MixedCurve MixCurves(const MicrofacetColors& at) {
  const double m = at.metallic * at.metal_scale,
               not_metal = (1 - at.metallic) * at.dielectric_scale;
  const double dielectric = at.dielectric_f0, metal = at.metal_f0;
  return {.f0 = not_metal * dielectric + m * metal,
          .turquin_f0 = not_metal * dielectric * dielectric + m * metal * metal,
          .turquin_f90 = not_metal * dielectric * at.dielectric_f90 + m * metal};
}

// The colours of channel c of a model.
inline MicrofacetColors ColorsOf(const MicrofacetModel& model, int c) {
  return {.base_color = 0,  // not kept by the model, and not needed any more
          .diffuse = model.diffuse[c],
          .metallic = model.metallic,
          .dielectric_f0 = model.dielectric_f0[c],
          .dielectric_f90 = model.dielectric_f90,
          .metal_f0 = model.metal_f0[c],
          .f82_slope = model.f82_slope[c],
          .dielectric_scale = model.dielectric_scale[c],
          .metal_scale = model.metal_scale,
          .cover = model.cover[c]};
}

// Means over the hemisphere of a lobe's directional albedos: for F = 1, for Schlick's weight, and,
// if HasExactCurve, for the exact Fresnel curve of the dielectric.
struct AlbedoAverages {
  double one = 1, schlick = 0, dielectric = 0;
};

// The means over the hemisphere, F_avg, of the Fresnel curves of dielectric and metal; by
// DeriveAverages, where they are Schlick's and F82's.
struct CurveAverages {
  double dielectric, metal;
};
NACRE_DERIVE CurveAverages DeriveAverages(const MicrofacetColors& at) {
  return {AverageSchlick(at.dielectric_f0, at.dielectric_f90),
          AverageF82(at.metal_f0, at.f82_slope)};
}

// One channel of the compensation of Kulla and Conty 2017: the colour F_ms of the second lobe for
// the dielectric and for the mix; and the base's `diffuse`, which where it is reciprocal is divided
// by the mean of 1 - the albedo of the dielectric above the base.
struct KullaContyChannel {
  double dielectric_f_multiple, f_multiple;
  double diffuse;
};
NACRE_DERIVE KullaContyChannel DeriveKullaConty(const MicrofacetForm& form,
                                                const MicrofacetColors& at,
                                                const CurveAverages& curves,
                                                const AlbedoAverages& albedo) {
  const double of_dielectric = KullaContyFresnel(curves.dielectric, albedo.one);
  const double of_metal = KullaContyFresnel(curves.metal, albedo.one);
  const double single =
      HasExactCurve(form.fresnel)
          ? albedo.dielectric
          : at.dielectric_f0 * (albedo.one - albedo.schlick) + at.dielectric_f90 * albedo.schlick;
  const double left = 1 - at.cover * single - at.cover * of_dielectric * (1 - albedo.one);
  // Where less is left than the rounding of an albedo in float, the base gets nothing: the quotient
  // would leave float's range before the small shares at hits bring it back.
  const bool any = left > 0x1p-23;
  const double scaled = any ? at.diffuse / (any ? left : 1) : 0;
  return {.dielectric_f_multiple = of_dielectric,
          .f_multiple = (1 - at.metallic) * at.dielectric_scale * of_dielectric +
                        at.metallic * at.metal_scale * of_metal,
          .diffuse = form.reciprocal ? scaled : at.diffuse};
}

// --- The albedo and ambient layers of output images. ---

// One channel of the albedo layer, and of the fraction of ambient light that is reflected.
struct ShownColors {
  double albedo, of_ambient;
};
// Used for metallic-roughness materials, too: base_color is the reflectance of both the diffuse
// base and a metal. The dielectric's specular reflection is left out, as in introductory texts.
NACRE_DERIVE ShownColors DeriveShown(double color) { return {color, color}; }
NACRE_DERIVE ShownColors DerivePhongShown(double color, double kd, double ka) {
  return {color * kd, color * ka};
}
// `gloss` is AverageDielectric of the index.
NACRE_DERIVE ShownColors DeriveDielectricShown(double color, double gloss) {
  return {color, gloss + color * (1 - gloss)};
}

// --- Constants in the form that kernels read. put(number, place) stores a number as float: Rounded
// for the constants of a material, AtHit for those of hit i. ---

struct Rounded {
  void operator()(double number, float& to) const { to = static_cast<float>(number); }
};
struct AtHit {
  size_t i;
  NACRE_DERIVE void operator()(double number, float* to) const {
    to[i] = static_cast<float>(number);
  }
};

template <class Put, class Constants>
NACRE_DERIVE void PutWidth(const LobeWidth& width, const Put& put, Constants* to) {
  put(width.shown_alpha, to->alpha);
  put(M_PI / (width.shown_alpha * width.shown_alpha), to->pi_over_alpha2);
  put(width.delta ? 0 : 1, to->not_delta);
  put(width.schlick_k, to->schlick_k);
}

// Stores the constants of channel c, and with the first channel those that all channels share.
template <class Put, class Constants>
NACRE_DERIVE void PutCurve(const MicrofacetColors& at, int c, const Put& put, Constants* to) {
  put(MixCurves(at).f0, to->f0[c]);
  put(at.dielectric_f0, to->dielectric_f0[c]);
  if (c > 0) return;
  put(MixedF90(at.dielectric_f90, at.metallic), to->f90);
  put(at.dielectric_f90, to->dielectric_f90);
}

template <class Put, class Constants>
NACRE_DERIVE void PutF82(const MicrofacetColors& at, int c, const Put& put, Constants* to) {
  put(at.metal_f0, to->metal_f0[c]);
  put(at.f82_slope, to->f82_slope[c]);
  if (c == 0) put(at.metallic, to->metallic);
}

template <class Put, class Constants>
NACRE_DERIVE void PutOpenPbr(const MicrofacetColors& at, int c, const Put& put, Constants* to) {
  PutF82(at, c, put, to);
  put((1 - at.metallic) * at.dielectric_scale, to->dielectric[c]);
  put(at.cover, to->cover[c]);
  if (c == 0) put(at.metallic * at.metal_scale, to->metal);
}

template <class Put, class Constants>
NACRE_DERIVE void PutKullaConty(const KullaContyChannel& at, int c, const Put& put, Constants* to) {
  put(at.f_multiple, to->f_multiple[c]);
  put(at.dielectric_f_multiple, to->dielectric_f_multiple[c]);
}

// --- Products of one channel with a light. ---

// The products with Schlick's curve; the names are those of MicrofacetLight. `not_delta` is 0 for a
// delta lobe, which punctual lights cannot show, else 1.
struct SchlickLight {
  double specular_f0, specular_rise, diffuse_normal, diffuse_grazing;
};
NACRE_DERIVE SchlickLight TimesLight(const MicrofacetForm& form, const MicrofacetColors& at,
                                     double diffuse, double light, double not_delta) {
  const bool coupled = form.coupling == DiffuseCoupling::kOneMinusFresnel;
  const double f0 = MixCurves(at).f0, f90 = MixedF90(at.dielectric_f90, at.metallic);
  const double lit = diffuse * light, specular = not_delta * light;
  return {.specular_f0 = f0 * specular,
          .specular_rise = (f90 - f0) * specular,
          .diffuse_normal = coupled ? (1 - f0) * lit : lit,
          .diffuse_grazing = coupled ? (1 - f90) * lit : 0};
}

template <class Put, class Light>
NACRE_DERIVE void PutSchlickLight(const SchlickLight& from, int c, const Put& put, Light* to) {
  put(from.specular_f0, to->specular_f0[c]);
  put(from.specular_rise, to->specular_rise[c]);
  put(from.diffuse_normal, to->diffuse_normal[c]);
  put(from.diffuse_grazing, to->diffuse_grazing[c]);
}

// `specular` is the light, or 0 for a delta lobe.
template <class Put, class Light>
NACRE_DERIVE void PutTurquinLight(const MicrofacetColors& at, double specular, int c,
                                  const Put& put, Light* to) {
  const MixedCurve mix = MixCurves(at);
  put(mix.turquin_f0 * specular, to->turquin_f0[c]);
  put((mix.turquin_f90 - mix.turquin_f0) * specular, to->turquin_rise[c]);
}

}  // namespace nacre
