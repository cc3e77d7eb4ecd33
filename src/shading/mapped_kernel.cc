// SPDX-License-Identifier: Apache-2.0
// shading/mapped_kernel.cc: the parameters of materials with maps at each hit, and the constants
// that the functions of derive.h derive from them. Plain loops, which the compiler vectorises for
// each target.
#include <algorithm>
#include <cmath>
#include <variant>

#include "scene/material_parameters.h"
#include "shading/kernels.h"
#include "shading/models_at_hit.h"
#include "shading/open_pbr.h"
#include "shading/surface.h"
#include "shading/texture_kernels.h"
#include "shading/thin_film.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading/mapped_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace {

struct Hits {
  size_t begin, end;

  // Calls at(i) for each hit.
  template <class Do>
  HWY_INLINE void Each(const Do& at) const {
    for (size_t i = begin; i < end; ++i) at(i);
  }

  // to[i] = of(i).
  template <class T, class Of>
  HWY_INLINE void Fill(T* HWY_RESTRICT to, const Of& of) const {
    for (size_t i = begin; i < end; ++i) to[i] = static_cast<T>(of(i));
  }
};

void StartNumbersT(const TexturedRun& run) {
  const Hits hits{run.begin, run.end};
  const Material& material = *run.material.scene_material;
  for (const MaterialMap& map : ModelOf(material)->maps) {
    for (const MapTarget& target : TargetsOf(map)) {
      const Rgb factor = target.factor(material);
      for (int c = 0; c < (target.is_color ? 3 : 1); ++c) {
        hits.Fill(ChannelOf(run.textures.numbers[static_cast<size_t>(target.number)], c).data(),
                  [&](size_t) { return factor[c]; });
      }
    }
  }
}

void MultiplyNumberT(const TexturedRun& run, const MapTarget& target) {
  const double most = target.most;
  const double least = target.least == nullptr ? 0 : target.least(*run.material.scene_material);
  for (int c = 0; c < (target.is_color ? 3 : 1); ++c) {
    const float* HWY_RESTRICT const texels =
        ChannelOf(run.textures.texels, target.is_color ? c : target.channel).data();
    double* HWY_RESTRICT const values =
        ChannelOf(run.textures.numbers[static_cast<size_t>(target.number)], c).data();
    for (size_t i = run.begin; i < run.end; ++i) {
      const double value = least + (values[i] - least) * double{texels[i]};
      values[i] = std::min(std::max(value, 0.0), most);
    }
  }
}

// Stores the albedo and ambient output layers of hits with parameters of their own. shown_of(c, i)
// is channel c of hit i.
template <class ShownOf>
void PutShown(const TexturedRun& run, const ShownOf& shown_of) {
  const Hits hits{run.begin, run.end};
  for (int c = 0; c < 3; ++c) {
    float *const albedo = ChannelOf(run.textures.albedo, c).data(),
                 *const ambient = ChannelOf(run.textures.ambient, c).data();
    const double radiance = run.material.in_ambient ? run.scene.ambient[c] : 0;
    hits.Each([&](size_t i) {
      const ShownColors at = shown_of(c, i);
      albedo[i] = static_cast<float>(at.albedo);
      ambient[i] = static_cast<float>(at.of_ambient * radiance);
    });
  }
}

void PutShown(const TexturedRun& run) {
  const Hits hits{run.begin, run.end};
  const double* color[3];
  for (int c = 0; c < 3; ++c) {
    const double* const emission = NumbersOf(run.textures, MappedNumber::kEmission, c);
    hits.Fill(ChannelOf(run.textures.emission, c).data(), [&](size_t i) { return emission[i]; });
    color[c] = NumbersOf(run.textures, MappedNumber::kColor, c);
  }
  const Material& material = *run.material.scene_material;
  if (const auto* phong = std::get_if<PhongMaterial>(&material.model)) {
    const Rgb kd = phong->kd, ka = phong->ka;
    PutShown(run, [&](int c, size_t i) { return DerivePhongShown(color[c][i], kd[c], ka[c]); });
  } else if (const auto* dielectric = std::get_if<DielectricMaterial>(&material.model)) {
    const double gloss = AverageDielectric(dielectric->ior);
    PutShown(run, [&](int c, size_t i) { return DeriveDielectricShown(color[c][i], gloss); });
  } else if (std::holds_alternative<ConductorMaterial>(material.model) ||
             std::holds_alternative<MeasuredMaterial>(material.model)) {  // have no colour map
    for (int c = 0; c < 3; ++c) {
      hits.Fill(ChannelOf(run.textures.albedo, c).data(),
                [&](size_t) { return run.material.albedo[c]; });
      const double ambient =
          run.material.in_ambient ? run.material.of_ambient[c] * run.scene.ambient[c] : 0;
      hits.Fill(ChannelOf(run.textures.ambient, c).data(), [&](size_t) { return ambient; });
    }
  } else {
    const auto* const open_pbr = std::get_if<OpenPbrMaterial>(&material.model);
    const Rgb subsurface = open_pbr != nullptr ? open_pbr->subsurface_color : Rgb(0);
    const double share = open_pbr != nullptr ? open_pbr->subsurface_weight : 0;
    const double weight = open_pbr != nullptr ? open_pbr->base_weight : 1;
    PutShown(run, [&](int c, size_t i) {
      return DeriveShown(DeriveDiffuseBase(weight * color[c][i], subsurface[c], share));
    });
  }
}

// Stores the constants of a rough diffuse surface; roughness(i) is that of hit i, and weight(i) a
// factor on its colour.
template <class Roughness, class Weight>
void PutMatte(const TexturedRun& run, DiffuseForm form, const Roughness& roughness,
              const Weight& weight, const MatteConstants<float*>& to) {
  if (form == DiffuseForm::kLambert) return;
  const Hits hits{run.begin, run.end};
  hits.Fill(to.roughness, roughness);
  if (form != DiffuseForm::kOrenNayar) return;
  for (int c = 0; c < 3; ++c) {
    const double* const color = NumbersOf(run.textures, MappedNumber::kColor, c);
    hits.Fill(to.ratio[c],
              [&](size_t i) { return EonMultipleRatio(color[i] * weight(i), roughness(i)); });
  }
}
template <class Roughness>
void PutMatte(const TexturedRun& run, DiffuseForm form, const Roughness& roughness,
              const MatteConstants<float*>& to) {
  PutMatte(
      run, form, roughness, [](size_t) { return 1.0; }, to);
}

void Finish(const TexturedRun& run, const MatteModel& model) {
  const auto to = ColumnsIn<MatteConstants<float*>>(run.textures.constants);
  PutMatte(
      run, model.form, [&](size_t) { return model.roughness; }, to);
}

void Finish(const TexturedRun& run, const PhongFamilyModel&) {
  const Hits hits{run.begin, run.end};
  const auto& phong = std::get<PhongMaterial>(run.material.scene_material->model);
  const double* const exponents = NumbersOf(run.textures, MappedNumber::kWidth);
  const auto to = ColumnsIn<PhongConstants<float*>>(run.textures.constants);
  hits.Fill(to.shininess, [&](size_t i) { return exponents[i]; });
  if (run.material.by_hit.width) {
    hits.Fill(run.textures.phong_scale.data(), [&](size_t i) {
      return DerivePhongScale(phong.model, phong.convention, exponents[i]);
    });
  } else {
    const double scale = DerivePhongScale(phong.model, phong.convention, phong.shininess);
    hits.Fill(run.textures.phong_scale.data(), [&](size_t) { return scale; });
  }
}

void PutFit(const AlbedoFit& fit, const AlbedoPolynomial& second, size_t i, HitParameters* t) {
  float* to = t->fit.data() + i;
  const auto put = [&](float value) {
    *to = value;
    to += HitParameters::kStride;
  };
  put(fit.shape.offset);
  put(fit.shape.scale);
  put(fit.shape.k);
  put(fit.shape.softening);
  for (const float coefficient : fit.one) put(coefficient);
  for (const float coefficient : second) put(coefficient);
}

// Whether the model's constants depend on means of its albedos.
bool NeedsAverages(const MicrofacetModel& model) {
  return model.compensation == Compensation::kKullaConty || model.reciprocal;
}

// Makes the lobes of anisotropic hits with alphas each. Hits with the same alphas as the hit before
// copy its lobe.
void PutLobes(const TexturedRun& run, const MicrofacetModel& model) {
  const Material& material = *run.material.scene_material;
  const double* const roughness = NumbersOf(run.textures, MappedNumber::kWidth);
  const double* const anisotropy = NumbersOf(run.textures, MappedNumber::kAnisotropy);
  std::vector<AnisotropicLobe>& lobes = run.textures.lobes;
  if (lobes.empty()) lobes.resize(kBatchCapacity + kBatchPadding);
  for (size_t i = run.begin; i < run.end; ++i) {
    const GgxAlphas<double> alpha = AlphasOf(material, roughness[i], anisotropy[i]);
    const bool same =
        i > run.begin && lobes[i - 1].alpha.x == alpha.x && lobes[i - 1].alpha.y == alpha.y;
    lobes[i] = same ? lobes[i - 1] : MakeAnisotropicLobe(model, alpha, roughness[i]);
  }
}

// Stores the albedos of the hits' lobes: the fits of hits with a roughness each, whose second curve
// is Schlick's or that of a dielectric's index; and the averages, if they are needed. Hits with the
// same roughness as the hit before reuse its fit.
void PutAlbedos(const TexturedRun& run, const MicrofacetModel& model) {
  const bool averages = NeedsAverages(model);
  if (!run.material.by_hit.width && !averages) return;
  const double* const roughness = NumbersOf(run.textures, MappedNumber::kWidth);
  AlbedoFit fit = model.albedo.lobe;
  DielectricCurve curve{model.albedo.fresnel, model.albedo.average};
  Rgb film_average = model.film ? model.film->albedo.average : Rgb(0);
  const AnisotropicLobes lobes = LobesOf(run.material, model, &run.textures);
  double last = -1;
  for (size_t i = run.begin; i < run.end; ++i) {
    if (run.material.by_hit.width && roughness[i] != last) {
      last = roughness[i];
      fit = averages ? MakeAlbedoFit(model.shadowing, last)
                     : BlendAlbedoCurves(model.shadowing, last);
      if (model.curves) curve = BlendDielectricCurves(*model.curves, last);
      if (model.film && !model.anisotropic) {
        film_average = BlendTableAlbedo(model.film->curves, last).average;
      }
    }
    if (run.material.by_hit.width) {
      PutFit(fit, model.curves ? curve.fresnel : fit.schlick, i, &run.textures);
    }
    for (int c = 0; c < 3; ++c) {
      const double of_curve = model.film ? film_average[c] : curve.average;
      const AlbedoAverages here =
          lobes.first != nullptr ? AveragesOf(model, lobes.At(i), c)
                                 : AlbedoAverages{fit.e_average, fit.schlick_average, of_curve};
      run.textures.one_average[i] = here.one;
      run.textures.schlick_average[i] = here.schlick;
      ChannelOf(run.textures.dielectric_average, c)[i] = here.dielectric;
    }
  }
}

// DeriveKullaConty of a channel at hit i.
template <class Channel>
struct KullaContyAt {
  KullaContyAt(const MicrofacetModel& model, const Channel& hits, const HitParameters& t, int c)
      : form(model),
        channel(hits),
        one(t.one_average.data()),
        schlick(t.schlick_average.data()),
        dielectric(ChannelOf(t.dielectric_average, c).data()) {}
  HWY_INLINE KullaContyChannel operator()(size_t i) const {
    const MicrofacetColors at = channel.Colors(i);
    return DeriveKullaConty(form, at, channel.Averages(at),
                            AlbedoAverages{one[i], schlick[i], dielectric[i]});
  }
  MicrofacetForm form;
  Channel channel;
  const double *one, *schlick, *dielectric;
};

void PutWidths(const TexturedRun& run, const MicrofacetModel& model,
               const MicrofacetConstants<float*>& to) {
  const double* const roughness = NumbersOf(run.textures, MappedNumber::kWidth);
  double* const sharp = run.textures.sharp_alpha.data();
  const Hits hits{run.begin, run.end};
  if (const AnisotropicLobes lobes = LobesOf(run.material, model, &run.textures);
      lobes.first != nullptr) {
    hits.Each([&](size_t i) { PutWidth(DeriveWidth(lobes.At(i).alpha), AtHit{i}, &to); });
    return;
  }
  hits.Each([&](size_t i) {
    const LobeWidth width = DeriveWidth(model.shadowing, roughness[i]);
    PutWidth(width, AtHit{i}, &to);
    sharp[i] = width.sharp_alpha;
  });
}

void PutBase(const TexturedRun& run, const MicrofacetModel& model,
             const MicrofacetConstants<float*>& to) {
  if (model.base_form == DiffuseForm::kLambert) return;
  const Material& material = *run.material.scene_material;
  std::optional<double> own;  // empty: the base has the lobe's roughness
  if (const auto* metallic = std::get_if<MetallicRoughnessMaterial>(&material.model)) {
    own = metallic->diffuse_roughness;
  } else if (const auto* dielectric = std::get_if<DielectricMaterial>(&material.model)) {
    own = dielectric->diffuse_roughness;
  }
  const double* const roughness = NumbersOf(run.textures, MappedNumber::kWidth);
  if (const auto* open_pbr = std::get_if<OpenPbrMaterial>(&material.model)) {
    const double* const metalness = NumbersOf(run.textures, MappedNumber::kMetallic);
    PutMatte(
        run, model.base_form, [&](size_t) { return open_pbr->base_diffuse_roughness; },
        [&](size_t i) { return WeightInRho(*open_pbr, metalness[i]); }, to.base);
  } else if (own) {
    PutMatte(
        run, model.base_form, [&](size_t) { return *own; }, to.base);
  } else {
    PutMatte(
        run, model.base_form, [&](size_t i) { return roughness[i]; }, to.base);
  }
}

// Stores what the films of hits make of F0, seen from the viewer.
void PutFilms(const TexturedRun& run) {
  HitParameters& t = run.textures;
  if (const auto* open_pbr = std::get_if<OpenPbrMaterial>(&run.material.scene_material->model)) {
    for (size_t i = run.begin; i < run.end; ++i) {
      const Rgb f0 =
          FilmedMetalAtHit(*open_pbr, ColorOfHit(t, MappedNumber::kColor, i),
                           ColorOfHit(t, MappedNumber::kSpecularColor, i), NDotV(run.surface, i));
      for (int c = 0; c < 3; ++c) ChannelOf(t.film_metal, c)[i] = f0[c];
    }
    return;
  }
  const auto& material = std::get<MetallicRoughnessMaterial>(run.material.scene_material->model);
  const double* const thickness = NumbersOf(t, MappedNumber::kFilmThickness);
  for (size_t i = run.begin; i < run.end; ++i) {
    const FilmedF0 filmed =
        FilmAtHit(material, thickness[i], ColorOfHit(t, MappedNumber::kColor, i),
                  ColorOfHit(t, MappedNumber::kSpecularColor, i), NDotV(run.surface, i));
    for (int c = 0; c < 3; ++c) {
      ChannelOf(t.film_dielectric, c)[i] = filmed.dielectric[c];
      ChannelOf(t.film_metal, c)[i] = filmed.metal[c];
    }
  }
}

void Finish(const TexturedRun& run, const MicrofacetModel& model) {
  const Hits hits{run.begin, run.end};
  const auto to = ColumnsIn<MicrofacetConstants<float*>>(run.textures.constants);
  const bool kulla_conty = model.compensation == Compensation::kKullaConty;
  if (const auto* open_pbr = std::get_if<OpenPbrMaterial>(&run.material.scene_material->model)) {
    double* const width = run.textures.numbers[static_cast<size_t>(MappedNumber::kWidth)].x.data();
    const double* const uncoated = NumbersOf(run.textures, MappedNumber::kUncoatedWidth);
    hits.Fill(width, [&](size_t i) { return RoughnessBelowCoat(*open_pbr, uncoated[i]); });
  }
  if (model.anisotropic && run.material.by_hit.width) PutLobes(run, model);
  PutWidths(run, model, to);
  if (model.film_by_hit || (model.film && model.film->metal_by_hit)) PutFilms(run);
  if (model.prepared) PutAlbedos(run, model);
  for (int c = 0; c < 3; ++c) {
    VisitChannel(run.material, run.textures, c, [&](const auto& channel) {
      hits.Each([&](size_t i) { PutCurve(channel.Colors(i), c, AtHit{i}, &to); });
      if (model.fresnel == FresnelForm::kF82) {
        hits.Each([&](size_t i) { PutF82(channel.Colors(i), c, AtHit{i}, &to); });
      } else if (HasCover(model.fresnel)) {
        hits.Each([&](size_t i) { PutOpenPbr(channel.Colors(i), c, AtHit{i}, &to); });
      }
      if (NeedsAverages(model)) {
        const KullaContyAt kulla_conty_at(model, channel, run.textures, c);
        hits.Each([&](size_t i) { PutKullaConty(kulla_conty_at(i), c, AtHit{i}, &to); });
      }
    });
  }
  if (kulla_conty) {
    const double* const one = run.textures.one_average.data();
    hits.Fill(to.multiple, [&](size_t i) { return KullaContyScale(one[i]); });
  }
  PutBase(run, model, to);
}

void Finish(const TexturedRun&, const std::monostate&) {}
void Finish(const TexturedRun&, const UserModel&) {}
void Finish(const TexturedRun&, const MeasuredModel&) {}

void FinishNumbersT(const TexturedRun& run) {
  PutShown(run);
  if (!run.material.by_hit.model) return;
  std::visit([&](const auto& model) { Finish(run, model); }, run.material.model);
}

void Multiply(const LitHits& lit, const MatteModel&, int c) {
  const double light = lit.light.color[c];
  const double* const color = NumbersOf(*lit.textures, MappedNumber::kColor, c);
  const auto to = ColumnsIn<MatteLight<float*>>(lit.textures->products);
  Hits{lit.begin, lit.end}.Fill(to.diffuse[c],
                                [&](size_t i) { return DeriveDiffuse(color[i]) * light; });
}

void Multiply(const LitHits& lit, const PhongFamilyModel&, int c) {
  const auto& phong = std::get<PhongMaterial>(lit.material.scene_material->model);
  const PhongConvention convention = phong.convention;
  const double light = lit.light.color[c], kd = phong.kd[c];
  const double* const color = NumbersOf(*lit.textures, MappedNumber::kColor, c);
  const double* const ks = NumbersOf(*lit.textures, MappedNumber::kSpecularColor, c);
  const double* const scale = lit.textures->phong_scale.data();
  const auto to = ColumnsIn<PhongLight<float*>>(lit.textures->products);
  Hits{lit.begin, lit.end}.Each([&](size_t i) {
    const PhongChannel at = DerivePhong(convention, kd, color[i], ks[i], scale[i]);
    to.diffuse[c][i] = static_cast<float>(at.diffuse * light);
    to.specular[c][i] = static_cast<float>(at.specular * light);
  });
}

template <class Channel, class Diffuse>
void Multiply(const LitHits& lit, const MicrofacetModel& model, int c, const Channel& channel,
              const Diffuse& diffuse) {
  const Hits hits{lit.begin, lit.end};
  const MicrofacetForm form = model;
  const double light = lit.light.color[c];
  const float* const not_delta =
      ColumnsIn<MicrofacetConstants<float*>>(lit.textures->constants).not_delta;
  const auto to = ColumnsIn<MicrofacetLight<float*>>(lit.textures->products);
  if (form.fresnel != FresnelForm::kSchlick) {
    hits.Each([&](size_t i) {
      to.diffuse[c][i] = static_cast<float>(diffuse(i) * light);
      to.specular[c][i] = static_cast<float>(double{not_delta[i]} * light);
    });
    return;
  }
  hits.Each([&](size_t i) {
    PutSchlickLight(TimesLight(form, channel.Colors(i), diffuse(i), light, double{not_delta[i]}), c,
                    AtHit{i}, &to);
  });
  if (form.compensation != Compensation::kTurquin) return;
  hits.Each([&](size_t i) {
    PutTurquinLight(channel.Colors(i), double{not_delta[i]} * light, c, AtHit{i}, &to);
  });
}

void Multiply(const LitHits& lit, const MicrofacetModel& model, int c) {
  VisitChannel(lit.material, *lit.textures, c, [&](const auto& channel) {
    if (!NeedsAverages(model)) {
      return Multiply(lit, model, c, channel, [&](size_t i) { return channel.Colors(i).diffuse; });
    }
    const KullaContyAt at(model, channel, *lit.textures, c);
    Multiply(lit, model, c, channel, [&](size_t i) { return at(i).diffuse; });
    if (model.compensation != Compensation::kKullaConty) return;
    const double light = lit.light.color[c];
    const auto to = ColumnsIn<MicrofacetLight<float*>>(lit.textures->products);
    Hits{lit.begin, lit.end}.Fill(to.multiple[c],
                                  [&](size_t i) { return at(i).f_multiple * light; });
  });
}

void Multiply(const LitHits&, const std::monostate&, int) {}
void Multiply(const LitHits&, const UserModel&, int) {}
void Multiply(const LitHits&, const MeasuredModel&, int) {}

void MakeProductsT(const LitHits& lit) {
  for (int c = 0; c < 3; ++c) {
    std::visit([&](const auto& model) { Multiply(lit, model, c); }, lit.material.model);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(StartNumbersT);
HWY_EXPORT(MultiplyNumberT);
HWY_EXPORT(FinishNumbersT);
HWY_EXPORT(MakeProductsT);

void StartNumbers(const TexturedRun& run) { HWY_DYNAMIC_DISPATCH(StartNumbersT)(run); }

void MultiplyNumber(const TexturedRun& run, const MapTarget& target) {
  HWY_DYNAMIC_DISPATCH(MultiplyNumberT)(run, target);
}

void FinishNumbers(const TexturedRun& run) {
  run.textures.products_end = 0;  // the products were made of other parameters
  HWY_DYNAMIC_DISPATCH(FinishNumbersT)(run);
}

void MakeProducts(const LitHits& lit) {
  HitParameters& t = *lit.textures;
  const bool are_there = t.products_begin == lit.begin && t.products_end == lit.end &&
                         t.products_color == lit.light.color;
  if (are_there) return;
  t.products_begin = lit.begin;
  t.products_end = lit.end;
  t.products_color = lit.light.color;
  HWY_DYNAMIC_DISPATCH(MakeProductsT)(lit);
}
}  // namespace nacre
#endif
