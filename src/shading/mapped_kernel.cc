// SPDX-License-Identifier: Apache-2.0
// shading/mapped_kernel.cc: the parameters of materials with maps at each hit, and the constants
// that the functions of derive.h derive from them. Plain loops, which the compiler vectorises for
// each target.
#include <algorithm>
#include <cmath>
#include <variant>

#include "scene/material_parameters.h"
#include "shading/mapped.h"
#include "shading/models_at_hit.h"
#include "shading/texture_kernels.h"

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

void StartNumbersT(const TexturedRun& run, HitParameters* t) {
  const Hits hits{run.begin, run.end};
  const Material& material = *run.material.scene_material;
  for (const MaterialMap& map : ModelOf(material)->maps) {
    for (const MapTarget& target : TargetsOf(map)) {
      const Rgb factor = target.factor(material);
      for (int c = 0; c < (target.is_color ? 3 : 1); ++c) {
        hits.Fill(ChannelOf(t->numbers[static_cast<size_t>(target.number)], c).data(),
                  [&](size_t) { return factor[c]; });
      }
    }
  }
}

void MultiplyNumberT(const TexturedRun& run, const MapTarget& target, HitParameters* t) {
  const double most = target.most;
  for (int c = 0; c < (target.is_color ? 3 : 1); ++c) {
    const float* HWY_RESTRICT const texels =
        ChannelOf(t->texels, target.is_color ? c : target.channel).data();
    double* HWY_RESTRICT const values =
        ChannelOf(t->numbers[static_cast<size_t>(target.number)], c).data();
    for (size_t i = run.begin; i < run.end; ++i) {
      values[i] = std::min(std::max(values[i] * double{texels[i]}, 0.0), most);
    }
  }
}

// Stores the albedo and ambient output layers of hits with parameters of their own. shown_of(c, i)
// is channel c of hit i.
template <class ShownOf>
void PutShown(const TexturedRun& run, const ShownOf& shown_of, HitParameters* t) {
  const Hits hits{run.begin, run.end};
  for (int c = 0; c < 3; ++c) {
    float *const albedo = ChannelOf(t->albedo, c).data(), *const ambient =
                                                              ChannelOf(t->ambient, c).data();
    const double radiance = run.material.in_ambient ? run.scene.ambient[c] : 0;
    hits.Each([&](size_t i) {
      const ShownColors at = shown_of(c, i);
      albedo[i] = static_cast<float>(at.albedo);
      ambient[i] = static_cast<float>(at.of_ambient * radiance);
    });
  }
}

void PutShown(const TexturedRun& run, HitParameters* t) {
  const Hits hits{run.begin, run.end};
  const double* color[3];
  for (int c = 0; c < 3; ++c) {
    const double* const emission = NumbersOf(*t, MappedNumber::kEmission, c);
    hits.Fill(ChannelOf(t->emission, c).data(), [&](size_t i) { return emission[i]; });
    color[c] = NumbersOf(*t, MappedNumber::kColor, c);
  }
  const Material& material = *run.material.scene_material;
  if (const auto* phong = std::get_if<PhongMaterial>(&material.model)) {
    const Rgb kd = phong->kd, ka = phong->ka;
    PutShown(
        run, [&](int c, size_t i) { return DerivePhongShown(color[c][i], kd[c], ka[c]); }, t);
  } else if (const auto* dielectric = std::get_if<DielectricMaterial>(&material.model)) {
    const double gloss = AverageDielectric(dielectric->ior);
    PutShown(
        run, [&](int c, size_t i) { return DeriveDielectricShown(color[c][i], gloss); }, t);
  } else if (std::holds_alternative<ConductorMaterial>(material.model)) {  // has no colour map
    for (int c = 0; c < 3; ++c) {
      hits.Fill(ChannelOf(t->albedo, c).data(), [&](size_t) { return run.material.albedo[c]; });
      const double ambient =
          run.material.in_ambient ? run.material.of_ambient[c] * run.scene.ambient[c] : 0;
      hits.Fill(ChannelOf(t->ambient, c).data(), [&](size_t) { return ambient; });
    }
  } else {
    PutShown(
        run, [&](int c, size_t i) { return DeriveShown(color[c][i]); }, t);
  }
}

// Stores the constants of a rough diffuse surface; roughness(i) is that of hit i.
template <class Roughness>
void PutMatte(const TexturedRun& run, DiffuseForm form, const Roughness& roughness,
              const MatteConstants<float*>& to, HitParameters* t) {
  if (form == DiffuseForm::kLambert) return;
  const Hits hits{run.begin, run.end};
  hits.Fill(to.roughness, roughness);
  if (form != DiffuseForm::kOrenNayar) return;
  for (int c = 0; c < 3; ++c) {
    const double* const color = NumbersOf(*t, MappedNumber::kColor, c);
    hits.Fill(to.ratio[c], [&](size_t i) { return EonMultipleRatio(color[i], roughness(i)); });
  }
}

void Finish(const TexturedRun& run, const MatteModel& model, HitParameters* t) {
  const auto to = ColumnsIn<MatteConstants<float*>>(t->constants);
  PutMatte(
      run, model.form, [&](size_t) { return model.roughness; }, to, t);
}

void Finish(const TexturedRun& run, const PhongFamilyModel&, HitParameters* t) {
  const Hits hits{run.begin, run.end};
  const auto& phong = std::get<PhongMaterial>(run.material.scene_material->model);
  const double* const exponents = NumbersOf(*t, MappedNumber::kWidth);
  const auto to = ColumnsIn<PhongConstants<float*>>(t->constants);
  hits.Fill(to.shininess, [&](size_t i) { return exponents[i]; });
  if (run.material.by_hit.width) {
    hits.Fill(t->phong_scale.data(), [&](size_t i) {
      return DerivePhongScale(phong.model, phong.convention, exponents[i]);
    });
  } else {
    const double scale = DerivePhongScale(phong.model, phong.convention, phong.shininess);
    hits.Fill(t->phong_scale.data(), [&](size_t) { return scale; });
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

// Stores the albedos of the hits' lobes: the fits of hits with a roughness each, whose second curve
// is Schlick's or that of a dielectric's index; and, for Kulla and Conty's compensation, the
// averages. Hits with the same roughness as the hit before reuse its fit.
void PutAlbedos(const TexturedRun& run, const MicrofacetModel& model, HitParameters* t) {
  const bool kulla_conty = model.compensation == Compensation::kKullaConty;
  if (!run.material.by_hit.width && !kulla_conty) return;
  const double* const roughness = NumbersOf(*t, MappedNumber::kWidth);
  AlbedoFit fit = model.albedo.lobe;
  DielectricCurve curve{model.albedo.fresnel, model.albedo.average};
  double last = -1;
  for (size_t i = run.begin; i < run.end; ++i) {
    if (run.material.by_hit.width && roughness[i] != last) {
      last = roughness[i];
      fit = kulla_conty ? MakeAlbedoFit(model.shadowing, last)
                        : BlendAlbedoCurves(model.shadowing, last);
      if (model.curves) curve = BlendDielectricCurves(*model.curves, last);
    }
    if (run.material.by_hit.width) PutFit(fit, model.curves ? curve.fresnel : fit.schlick, i, t);
    t->one_average[i] = fit.e_average;
    t->schlick_average[i] = fit.schlick_average;
    t->dielectric_average[i] = curve.average;
  }
}

// DeriveKullaConty of a channel at hit i.
template <class Channel>
struct KullaContyAt {
  KullaContyAt(const MicrofacetModel& model, const Channel& hits, const HitParameters& t)
      : form(model),
        channel(hits),
        one(t.one_average.data()),
        schlick(t.schlick_average.data()),
        dielectric(t.dielectric_average.data()) {}
  HWY_INLINE KullaContyChannel operator()(size_t i) const {
    const MicrofacetColors at = channel.Colors(i);
    return DeriveKullaConty(form, at, channel.Averages(at),
                            AlbedoAverages{one[i], schlick[i], dielectric[i]});
  }
  MicrofacetForm form;
  Channel channel;
  const double *one, *schlick, *dielectric;
};

void PutWidths(const TexturedRun& run, Shadowing shadowing, const MicrofacetConstants<float*>& to,
               HitParameters* t) {
  const double* const roughness = NumbersOf(*t, MappedNumber::kWidth);
  double* const sharp = t->sharp_alpha.data();
  Hits{run.begin, run.end}.Each([&](size_t i) {
    const LobeWidth width = DeriveWidth(shadowing, roughness[i]);
    PutWidth(width, AtHit{i}, &to);
    sharp[i] = width.sharp_alpha;
  });
}

void PutBase(const TexturedRun& run, const MicrofacetModel& model,
             const MicrofacetConstants<float*>& to, HitParameters* t) {
  if (model.base_form == DiffuseForm::kLambert) return;
  const Material& material = *run.material.scene_material;
  std::optional<double> own;  // empty: the base has the lobe's roughness
  if (const auto* metallic = std::get_if<MetallicRoughnessMaterial>(&material.model)) {
    own = metallic->diffuse_roughness;
  } else if (const auto* dielectric = std::get_if<DielectricMaterial>(&material.model)) {
    own = dielectric->diffuse_roughness;
  }
  const double* const roughness = NumbersOf(*t, MappedNumber::kWidth);
  if (own) {
    PutMatte(
        run, model.base_form, [&](size_t) { return *own; }, to.base, t);
  } else {
    PutMatte(
        run, model.base_form, [&](size_t i) { return roughness[i]; }, to.base, t);
  }
}

void Finish(const TexturedRun& run, const MicrofacetModel& model, HitParameters* t) {
  const Hits hits{run.begin, run.end};
  const auto to = ColumnsIn<MicrofacetConstants<float*>>(t->constants);
  const bool kulla_conty = model.compensation == Compensation::kKullaConty;
  PutWidths(run, model.shadowing, to, t);
  if (model.prepared) PutAlbedos(run, model, t);
  for (int c = 0; c < 3; ++c) {
    VisitChannel(run.material, *t, c, [&](const auto& channel) {
      hits.Each([&](size_t i) { PutCurve(channel.Colors(i), c, AtHit{i}, &to); });
      if (model.fresnel == FresnelForm::kF82) {
        hits.Each([&](size_t i) { PutF82(channel.Colors(i), c, AtHit{i}, &to); });
      }
      if (kulla_conty) {
        const KullaContyAt kulla_conty_at(model, channel, *t);
        hits.Each([&](size_t i) { PutKullaConty(kulla_conty_at(i), c, AtHit{i}, &to); });
      }
    });
  }
  if (kulla_conty) {
    hits.Fill(to.multiple, [&](size_t i) { return KullaContyScale(t->one_average[i]); });
  }
  PutBase(run, model, to, t);
}

void Finish(const TexturedRun&, const std::monostate&, HitParameters*) {}
void Finish(const TexturedRun&, const UserModel&, HitParameters*) {}

void FinishNumbersT(const TexturedRun& run, HitParameters* t) {
  PutShown(run, t);
  if (!run.material.by_hit.model) return;
  std::visit([&](const auto& model) { Finish(run, model, t); }, run.material.model);
}

void Multiply(const MappedProducts& products, const MatteModel&, int c, HitParameters* t) {
  const double light = products.color[c];
  const double* const color = NumbersOf(*t, MappedNumber::kColor, c);
  const auto to = ColumnsIn<MatteLight<float*>>(t->products);
  Hits{products.begin, products.end}.Fill(
      to.diffuse[c], [&](size_t i) { return DeriveDiffuse(color[i]) * light; });
}

void Multiply(const MappedProducts& products, const PhongFamilyModel&, int c, HitParameters* t) {
  const auto& phong = std::get<PhongMaterial>(products.material.scene_material->model);
  const PhongConvention convention = phong.convention;
  const double light = products.color[c], kd = phong.kd[c];
  const double* const color = NumbersOf(*t, MappedNumber::kColor, c);
  const double* const ks = NumbersOf(*t, MappedNumber::kSpecularColor, c);
  const double* const scale = t->phong_scale.data();
  const auto to = ColumnsIn<PhongLight<float*>>(t->products);
  Hits{products.begin, products.end}.Each([&](size_t i) {
    const PhongChannel at = DerivePhong(convention, kd, color[i], ks[i], scale[i]);
    to.diffuse[c][i] = static_cast<float>(at.diffuse * light);
    to.specular[c][i] = static_cast<float>(at.specular * light);
  });
}

template <class Channel, class Diffuse>
void Multiply(const MappedProducts& products, const MicrofacetModel& model, int c,
              const Channel& channel, const Diffuse& diffuse, HitParameters* t) {
  const Hits hits{products.begin, products.end};
  const MicrofacetForm form = model;
  const double light = products.color[c];
  const float* const not_delta = ColumnsIn<MicrofacetConstants<float*>>(t->constants).not_delta;
  const auto to = ColumnsIn<MicrofacetLight<float*>>(t->products);
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

void Multiply(const MappedProducts& products, const MicrofacetModel& model, int c,
              HitParameters* t) {
  VisitChannel(products.material, *t, c, [&](const auto& channel) {
    if (model.compensation != Compensation::kKullaConty) {
      return Multiply(
          products, model, c, channel, [&](size_t i) { return channel.Colors(i).diffuse; }, t);
    }
    const KullaContyAt at(model, channel, *t);
    Multiply(
        products, model, c, channel, [&](size_t i) { return at(i).diffuse; }, t);
    const double light = products.color[c];
    const auto to = ColumnsIn<MicrofacetLight<float*>>(t->products);
    Hits{products.begin, products.end}.Fill(to.multiple[c],
                                            [&](size_t i) { return at(i).f_multiple * light; });
  });
}

void Multiply(const MappedProducts&, const std::monostate&, int, HitParameters*) {}
void Multiply(const MappedProducts&, const UserModel&, int, HitParameters*) {}

void MakeProductsT(const MappedProducts& products, HitParameters* t) {
  for (int c = 0; c < 3; ++c) {
    std::visit([&](const auto& model) { Multiply(products, model, c, t); },
               products.material.model);
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

void StartNumbers(const TexturedRun& run, HitParameters* textures) {
  HWY_DYNAMIC_DISPATCH(StartNumbersT)(run, textures);
}

void MultiplyNumber(const TexturedRun& run, const MapTarget& target, HitParameters* textures) {
  HWY_DYNAMIC_DISPATCH(MultiplyNumberT)(run, target, textures);
}

void FinishNumbers(const TexturedRun& run, HitParameters* textures) {
  textures->products_end = 0;  // the products were made of other parameters
  HWY_DYNAMIC_DISPATCH(FinishNumbersT)(run, textures);
}

void MakeProducts(const MappedProducts& products, HitParameters* textures) {
  HitParameters& t = *textures;
  const bool are_there = t.products_begin == products.begin && t.products_end == products.end &&
                         t.products_color == products.color;
  if (are_there) return;
  t.products_begin = products.begin;
  t.products_end = products.end;
  t.products_color = products.color;
  HWY_DYNAMIC_DISPATCH(MakeProductsT)(products, textures);
}
}  // namespace nacre
#endif
