// SPDX-License-Identifier: Apache-2.0
// shading/models_at_hit.h: applies derive.h to hits with parameters of their own, which are in
// HitParameters::numbers.
#pragma once

#include <variant>

#include "scene/material.h"
#include "shading/derive.h"
#include "shading/hit_parameters.h"
#include "shading/material.h"
#include "shading/open_pbr.h"

namespace nacre {

// MetallicRoughnessHits, ConductorHits, DielectricHits and OpenPbrHits give one channel of a
// microfacet material at hit i: Colors(i), and Averages(colors) of these.
struct MetallicRoughnessHits {
  MetallicRoughnessHits(const MetallicRoughnessMaterial& material, const MicrofacetModel& model,
                        const HitParameters& t, int c)
      : base_color(NumbersOf(t, MappedNumber::kColor, c)),
        metallic(NumbersOf(t, MappedNumber::kMetallic)),
        dielectric_f0(NumbersOf(t, MappedNumber::kSpecularColor, c)),
        specular(NumbersOf(t, MappedNumber::kSpecular)),
        tint(model.fresnel == FresnelForm::kF82 ? material.f82_tint[c] : 1) {}

  NACRE_DERIVE MicrofacetColors Colors(size_t i) const {
    return DeriveMetallicRoughness(base_color[i], metallic[i], dielectric_f0[i], specular[i], tint);
  }
  NACRE_DERIVE CurveAverages Averages(const MicrofacetColors& at) const {
    return DeriveAverages(at);
  }

  const double *base_color, *metallic, *dielectric_f0, *specular;
  double tint;
};

// The same under films that differ by hit (MicrofacetModel::film_by_hit).
struct FilmedHits : MetallicRoughnessHits {
  FilmedHits(const MetallicRoughnessHits& under, const HitParameters& t, int c)
      : MetallicRoughnessHits(under),
        film(NumbersOf(t, MappedNumber::kFilm)),
        film_dielectric(ChannelOf(t.film_dielectric, c).data()),
        film_metal(ChannelOf(t.film_metal, c).data()) {}

  NACRE_DERIVE MicrofacetColors Colors(size_t i) const {
    return DeriveFilmedAtHit(MetallicRoughnessHits::Colors(i), film[i], film_dielectric[i],
                             film_metal[i]);
  }

  const double *film, *film_dielectric, *film_metal;
};

struct ConductorHits {
  ConductorHits(const ConductorMaterial&, const MicrofacetModel& model, const HitParameters&, int c)
      : f0(model.metal_f0[c]), slope(model.f82_slope[c]), average(model.metal_f_average[c]) {}

  NACRE_DERIVE MicrofacetColors Colors(size_t) const { return DeriveConductor(f0, slope); }
  NACRE_DERIVE CurveAverages Averages(const MicrofacetColors&) const { return {0, average}; }

  double f0, slope, average;
};

struct DielectricHits {
  DielectricHits(const DielectricMaterial&, const MicrofacetModel& model, const HitParameters& t,
                 int c)
      : base_color(NumbersOf(t, MappedNumber::kColor, c)),
        f0(model.dielectric_f0[c]),
        average(model.dielectric_f_average[c]) {}

  NACRE_DERIVE MicrofacetColors Colors(size_t i) const {
    return DeriveDielectric(base_color[i], f0);
  }
  NACRE_DERIVE CurveAverages Averages(const MicrofacetColors&) const { return {average, 0}; }

  const double* base_color;
  double f0, average;
};

struct OpenPbrHits {
  OpenPbrHits(const OpenPbrMaterial& of, const MicrofacetModel& model, const HitParameters& t,
              int c)
      : material(of),
        base_color(NumbersOf(t, MappedNumber::kColor, c)),
        metalness(NumbersOf(t, MappedNumber::kMetallic)),
        specular_color(NumbersOf(t, MappedNumber::kSpecularColor, c)),
        specular_red(NumbersOf(t, MappedNumber::kSpecularColor, 0)),
        specular_green(NumbersOf(t, MappedNumber::kSpecularColor, 1)),
        specular_blue(NumbersOf(t, MappedNumber::kSpecularColor, 2)),
        subsurface_color(of.subsurface_color[c]),
        f0(model.dielectric_f0[c]),
        average(model.dielectric_f_average[c]) {}

  NACRE_DERIVE MicrofacetColors Colors(size_t i) const {
    const double largest = std::max(std::max(specular_red[i], specular_green[i]), specular_blue[i]);
    return DeriveOpenPbr(
        material, {base_color[i], metalness[i], subsurface_color, specular_color[i], largest}, f0);
  }
  NACRE_DERIVE CurveAverages Averages(const MicrofacetColors& at) const {
    return {average, DeriveAverages(at).metal};
  }

  const OpenPbrMaterial& material;
  const double *base_color, *metalness, *specular_color;
  const double *specular_red, *specular_green, *specular_blue;
  double subsurface_color, f0, average;
};

// The same below a coat that changes the metal (ChangesMetal).
struct CoatedMetalHits : OpenPbrHits {
  NACRE_DERIVE MicrofacetColors Colors(size_t i) const {
    return WithMetalBelowCoat(material, specular_color[i], OpenPbrHits::Colors(i));
  }
};

// The same under a thin film, whose curves are the same at all hits, but for what metal_by_hit
// says.
template <class Hits>
struct HitsUnderFilm {
  HitsUnderFilm(const Hits& under, const MicrofacetModel& model, const HitParameters& t, int c)
      : hits(under),
        dielectric_f0(model.dielectric_f0[c]),
        metal_f0(model.metal_f0[c]),
        averages{model.dielectric_f_average[c], model.metal_f_average[c]},
        metal_by_hit(model.film->metal_by_hit),
        film_metal(ChannelOf(t.film_metal, c).data()) {}

  NACRE_DERIVE MicrofacetColors Colors(size_t i) const {
    MicrofacetColors at =
        DeriveUnderFilm(hits.Colors(i), dielectric_f0, metal_by_hit ? film_metal[i] : metal_f0);
    if (metal_by_hit) at.f82_slope = 0;
    return at;
  }
  NACRE_DERIVE CurveAverages Averages(const MicrofacetColors& at) const {
    return {averages.dielectric, metal_by_hit ? DeriveAverages(at).metal : averages.metal};
  }

  Hits hits;
  double dielectric_f0, metal_f0;
  CurveAverages averages;
  bool metal_by_hit;
  const double* film_metal;
};

// Calls use(hits) with one of these for channel c of the material, which must have a
// MicrofacetModel.
template <class Use>
void VisitChannel(const ShadingMaterial& material, const HitParameters& t, int c, const Use& use) {
  const auto& model = std::get<MicrofacetModel>(material.model);
  const Material& of = *material.scene_material;
  const auto use_hits = [&](const auto& hits) {
    if (model.film) {
      use(HitsUnderFilm(hits, model, t, c));
    } else {
      use(hits);
    }
  };
  if (const auto* metallic = std::get_if<MetallicRoughnessMaterial>(&of.model)) {
    const MetallicRoughnessHits hits(*metallic, model, t, c);
    if (model.film_by_hit) return use(FilmedHits(hits, t, c));
    use_hits(hits);
  } else if (const auto* open_pbr = std::get_if<OpenPbrMaterial>(&of.model)) {
    const OpenPbrHits hits(*open_pbr, model, t, c);
    if (ChangesMetal(*open_pbr)) return use_hits(CoatedMetalHits{hits});
    use_hits(hits);
  } else if (const auto* conductor = std::get_if<ConductorMaterial>(&of.model)) {
    use(ConductorHits(*conductor, model, t, c));
  } else {
    use(DielectricHits(std::get<DielectricMaterial>(of.model), model, t, c));
  }
}

}  // namespace nacre
