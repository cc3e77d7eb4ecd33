// SPDX-License-Identifier: Apache-2.0
#include "shading/thin_film.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "base/memo.h"
#include "brdf/fresnel.h"
#include "brdf/open_pbr.h"
#include "brdf/quadrature.h"
#include "brdf/thin_film.h"
#include "shading/open_pbr.h"

namespace nacre {
namespace {

// 1 - R of each channel at a cosine.
using Loss = std::function<Rgb(double cosine)>;

// `weight` of a film's curve, and of `filmless` what is left.
FresnelCurve Blend(FresnelCurve curve, double weight, const Loss& filmless) {
  if (weight >= 1) return curve;
  return {[=, film = std::move(curve.loss)](double cosine) {
            return film(cosine) * weight + filmless(cosine) * (1 - weight);
          },
          0, curve.corner};
}

Rgb ReflectedAverage(const FresnelTable& table) {
  return MakeRgb([&](int c) {
    return IntegrateTowardsZero(
        [&](double mu) {
          return 2 * mu * (1 - FresnelTableLoss(table, mu)[static_cast<size_t>(c)]);
        },
        20);
  });
}

// What the fits of a table depend on.
struct TableFitKey {
  Shadowing shadowing;
  double roughness;
  FresnelTable table;

  bool operator==(const TableFitKey&) const = default;
};

// Fits are kept, as those of dielectrics are (material.cc).
TableAlbedoFit TableFitOf(Shadowing shadowing, double roughness, const FresnelTable& table) {
  static Memo<TableFitKey, TableAlbedoFit> memo;
  return *memo.Get({shadowing, roughness, table}, [&] {
    return MakeTableAlbedoFit(shadowing, roughness, MakeAlbedoFit(shadowing, roughness), table);
  });
}

TableAlbedoCurves TableCurvesOf(Shadowing shadowing, const FresnelTable& table) {
  static Memo<TableFitKey, TableAlbedoCurves> memo;
  return *memo.Get({shadowing, 0, table}, [&] { return MakeTableAlbedoCurves(shadowing, table); });
}

std::shared_ptr<const ThinFilmLobe> MakeFilmLobe(const std::function<FresnelCurve()>& dielectric,
                                                 const std::function<FresnelCurve()>& metal,
                                                 double film_index, const FilmUse& use) {
  auto film = std::make_shared<ThinFilmLobe>();
  film->bend = FresnelBend(film_index);
  film->has_dielectric = use.dielectric;
  film->has_metal = use.metal;
  film->metal_by_hit = use.metal_by_hit;
  film->metal = MakeFresnelTable(metal());
  film->metal_average = ReflectedAverage(film->metal);
  film->dielectric = MakeFresnelTable(dielectric());
  film->dielectric_average = ReflectedAverage(film->dielectric);
  // Hits with a roughness each ask for the albedo of the dielectric even where there is only metal.
  if (use.is_anisotropic || (!use.dielectric && !use.roughness_by_hit)) return film;
  film->albedo = TableFitOf(use.shadowing, use.roughness, film->dielectric);
  if (use.roughness_by_hit) film->curves = TableCurvesOf(use.shadowing, film->dielectric);
  return film;
}

// --- OpenPBR. ---

ThinFilmOptions FilmOptionsOf(ThinFilmForm form) {
  ThinFilmOptions options;
  if (form == ThinFilmForm::kBelcourBarla) options.model = ThinFilmModel::kBelcourBarla;
  if (form == ThinFilmForm::kLines) options.model = ThinFilmModel::kThreeLines;
  return options;
}

// What lies above the film, and the cosine there of light that comes from the air at a cosine.
struct Outside {
  double index;
  bool refracts;  // the index is a coat's, in which light has another cosine
};

double CosineIn(const Outside& outside, double cosine) {
  if (!outside.refracts) return cosine;
  const double sine2 = (1 - cosine) * (1 + cosine) / (outside.index * outside.index);
  return std::sqrt(std::max(1 - sine2, 0.0));
}

// The curve of a film of which a coat, where there is one, covers the fraction `coverage`.
// make_curve(outside) gives that below one medium.
template <class MakeCurve>
FresnelCurve BelowCoat(const OpenPbrMaterial& m, const MakeCurve& make_curve) {
  const double coverage = m.coat_weight;
  const bool is_below = coverage > 0 && m.options.film_outside == FilmOutside::kCoat;
  if (is_below && m.options.coat_fresnel == CoatFresnel::kIndexLerp) {
    return make_curve(Outside{1 + (m.coat_ior - 1) * coverage, false});
  }
  const bool refracts = is_below && m.options.coat_fresnel == CoatFresnel::kRefractCosine;
  if (!refracts) return make_curve(Outside{1, false});
  const Outside coat{m.coat_ior, true};
  const FresnelCurve covered = make_curve(coat);
  const Loss below = [=](double cosine) { return covered.loss(CosineIn(coat, cosine)); };
  if (coverage >= 1) return {below, 0, 0};
  return Blend(make_curve(Outside{1, false}), 1 - coverage, below);
}

ThinFilm FilmBelow(const OpenPbrMaterial& m, const Outside& outside) {
  return {outside.index, m.thin_film_ior, 1000 * m.thin_film_thickness};
}

double FilmWeight(const OpenPbrMaterial& m) {
  return m.thin_film_weight * ThinFilmShare(1000 * m.thin_film_thickness, m.options.film_fade_nm);
}

// 1 - R of a metal of these colours, of which films cover a fraction.
FresnelCurve FilmOnMetal(const OpenPbrMaterial& m, const Rgb& base_color,
                         const Rgb& specular_color) {
  RgbSubstrate below;
  Rgb f0, slope;
  for (int c = 0; c < 3; ++c) {
    f0[c] = m.base_weight * base_color[c];
    slope[c] = F82SlopeFromTint(f0[c], specular_color[c]);
    below[static_cast<size_t>(c)] = MetalBelow(m.options.film_metal, f0[c], specular_color[c]);
  }
  const FresnelCurve curve = BelowCoat(m, [&](const Outside& outside) {
    return ThinFilmCurve(FilmBelow(m, outside), below, FilmOptionsOf(m.options.film));
  });
  return Blend(curve, FilmWeight(m), [=](double cosine) {
    return MakeRgb([&](int c) { return 1 - FresnelF82(cosine, 1 - cosine, f0[c], slope[c]); });
  });
}

// F0 of Schlick's curve that reflects at n.v what the film does. The curve is 1 at grazing
// incidence whatever its F0, which is then of no account.
Rgb SchlickF0(const FresnelCurve& film, double n_dot_v) {
  const double grazing = std::pow(1 - n_dot_v, 5);
  if (!(grazing < 1)) return Rgb(1);
  const Rgb loss = film.loss(n_dot_v);
  return MakeRgb([&](int c) { return 1 - std::clamp(loss[c] / (1 - grazing), 0.0, 1.0); });
}

}  // namespace

std::shared_ptr<const ThinFilmLobe> MakeThinFilmLobe(const OpenPbrMaterial& m, const FilmUse& use) {
  const double weight = FilmWeight(m);
  if (!(weight > 0)) return nullptr;
  const auto dielectric = [&] {
    const CoatedDielectric<double> bare = DielectricOf(m);
    const bool has_ratio = m.coat_weight > 0 && m.options.coat_fresnel == CoatFresnel::kInvertRatio;
    const FresnelCurve curve = BelowCoat(m, [&](const Outside& outside) {
      // MaterialX takes the ratio of base and coat for the index below a film in air.
      const double below =
          has_ratio ? bare.eta : outside.index * RelativeIndexBelow(m, outside.index);
      return ThinFilmCurve(FilmBelow(m, outside), SameSubstrate({below}),
                           FilmOptionsOf(m.options.film));
    });
    return Blend(curve, weight, [=](double cosine) {
      return Rgb(1 - FresnelCoatedDielectric(cosine, 1 - cosine, bare));
    });
  };
  const auto metal = [&] { return FilmOnMetal(m, m.base_color, m.specular_color); };
  return MakeFilmLobe(dielectric, metal, m.thin_film_ior, use);
}

bool MetalVariesBelowFilm(const OpenPbrMaterial& m, bool base_by_hit) {
  const bool has_metal = (m.base_metalness > 0) && m.specular_weight > 0;
  return has_metal && (base_by_hit || m.base_color_map.valid() || m.specular_color_map.valid());
}

Rgb FilmedMetalAtHit(const OpenPbrMaterial& m, const Rgb& base_color, const Rgb& specular_color,
                     double n_dot_v) {
  return SchlickF0(FilmOnMetal(m, base_color, specular_color), n_dot_v);
}

namespace {

// --- Metallic-roughness. ---

// 1 - R under a film over what reflects `f0` at normal incidence, of the index `below`.
FresnelCurve FilmOver(const MetallicRoughnessMaterial& m, double thickness_nm, const Rgb& f0,
                      const RgbSubstrate& below) {
  const ThinFilm film{1, m.iridescence_ior, thickness_nm};
  if (m.iridescence_model == ThinFilmForm::kGltf) {
    return {[=](double cosine) { return Rgb(1) - GltfIridescence(film, f0, cosine); }};
  }
  return ThinFilmCurve(film, below, FilmOptionsOf(m.iridescence_model));
}

RgbSubstrate DielectricsBelow(const Rgb& f0) {
  return {RealIndex(f0.x), RealIndex(f0.y), RealIndex(f0.z)};
}

RgbSubstrate MetalsBelow(const MetallicRoughnessMaterial& m, const Rgb& f0) {
  RgbSubstrate below;
  for (int c = 0; c < 3; ++c) {
    below[static_cast<size_t>(c)] = MetalBelow(FilmMetal::kGulbrandsenF82, f0[c], m.f82_tint[c]);
  }
  return below;
}

}  // namespace

std::shared_ptr<const ThinFilmLobe> MakeThinFilmLobe(const MetallicRoughnessMaterial& m,
                                                     const FilmUse& use) {
  if (!(m.iridescence > 0)) return nullptr;
  // With what reflects by Schlick's curve, or by F82's, where there is no film.
  const auto curve = [&](const Rgb& f0, const Rgb& slope, const RgbSubstrate& below) {
    const FresnelCurve with = FilmOver(m, m.iridescence_thickness_nm, f0, below);
    return Blend(with, m.iridescence, [=](double cosine) {
      return MakeRgb([&](int c) { return 1 - FresnelF82(cosine, 1 - cosine, f0[c], slope[c]); });
    });
  };
  const auto dielectric = [&] {
    return curve(m.dielectric_f0, Rgb(0), DielectricsBelow(m.dielectric_f0));
  };
  const auto metal = [&] {
    const Rgb slope =
        MakeRgb([&](int c) { return F82SlopeFromTint(m.base_color[c], m.f82_tint[c]); });
    return curve(m.base_color, slope, MetalsBelow(m, m.base_color));
  };
  return MakeFilmLobe(dielectric, metal, m.iridescence_ior, use);
}

bool FilmVaries(const MetallicRoughnessMaterial& m, bool base_by_hit) {
  if (!(m.iridescence > 0)) return false;
  if (m.iridescence_map.valid() || m.iridescence_thickness_map.valid()) return true;
  const bool maps_metallic = m.metallic_roughness_map.valid();
  const bool has_metal = m.metallic > 0, has_dielectric = m.metallic < 1 || maps_metallic;
  return (has_metal && (base_by_hit || m.base_color_map.valid())) ||
         (has_dielectric && m.specular_color_map.valid());
}

FilmedF0 FilmAtHit(const MetallicRoughnessMaterial& m, double thickness_nm, const Rgb& base_color,
                   const Rgb& dielectric_f0, double n_dot_v) {
  FilmedF0 filmed{Rgb(0), Rgb(0)};
  if (m.metallic < 1 || m.metallic_roughness_map.valid()) {
    filmed.dielectric = SchlickF0(
        FilmOver(m, thickness_nm, dielectric_f0, DielectricsBelow(dielectric_f0)), n_dot_v);
  }
  if (m.metallic > 0) {
    filmed.metal =
        SchlickF0(FilmOver(m, thickness_nm, base_color, MetalsBelow(m, base_color)), n_dot_v);
  }
  return filmed;
}

}  // namespace nacre
