// SPDX-License-Identifier: Apache-2.0
// shading/mapped_kernel.cc: what maps make of a material at each hit, and the products of that with
// a light. The arithmetic is that of material.cc and shade.cc, operation by operation, in double:
// where a map is constant, the bits are those of the constant material. Plain loops, which the
// compiler makes vectors of for each target. Lobes: mapped_microfacet_kernel.cc.
#include <algorithm>
#include <cmath>

#include "brdf/phong.h"
#include "scene/limits.h"
#include "shading/mapped.h"
#include "shading/texture_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading/mapped_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "shading/mapped-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace {

// value *= texel, kept within [0, most].
void Multiply(const Hits& hits, const float* HWY_RESTRICT texels, double most,
              double* HWY_RESTRICT values) {
  for (size_t i = hits.begin; i < hits.end; ++i) {
    values[i] = std::min(std::max(values[i] * double{texels[i]}, 0.0), most);
  }
}

void StartMaterialT(const TexturedRun& run, HitTextures* t) {
  const Hits hits{run.begin, run.end};
  const Material& material = *run.material.textured;
  for (int c = 0; c < 3; ++c) {
    const auto emission = static_cast<float>(run.material.emission[c]);
    std::fill(Channel(t->emission, c) + run.begin, Channel(t->emission, c) + run.end, emission);
    const auto albedo = static_cast<float>(run.material.albedo[c]);
    std::fill(Channel(t->albedo, c) + run.begin, Channel(t->albedo, c) + run.end, albedo);
    const auto ambient = static_cast<float>(run.material.ambient[c]);
    std::fill(Channel(t->ambient, c) + run.begin, Channel(t->ambient, c) + run.end, ambient);
  }
  if (const auto* lambert = std::get_if<LambertMaterial>(&material.model)) {
    FillRgb(hits, lambert->albedo, &t->diffuse);
  } else if (const auto* rough = std::get_if<OrenNayarMaterial>(&material.model)) {
    FillRgb(hits, rough->albedo, &t->diffuse);
  } else if (const auto* burley = std::get_if<BurleyMaterial>(&material.model)) {
    FillRgb(hits, burley->albedo, &t->diffuse);
  } else if (const auto* phong = std::get_if<PhongMaterial>(&material.model)) {
    FillRgb(hits, phong->color, &t->diffuse);
    FillRgb(hits, phong->ks, &t->specular);
    FillNumber(hits, phong->shininess, &t->width);
  } else if (const auto* metallic = std::get_if<MetallicRoughnessMaterial>(&material.model)) {
    FillRgb(hits, metallic->base_color, &t->diffuse);
    FillRgb(hits, metallic->dielectric_f0, &t->specular);
    FillNumber(hits, metallic->specular, &t->exact_dielectric_f90);
    FillNumber(hits, metallic->metallic, &t->metallic);
    FillNumber(hits, metallic->roughness, &t->width);
  } else if (const auto* conductor = std::get_if<ConductorMaterial>(&material.model)) {
    FillNumber(hits, conductor->roughness, &t->width);
  } else if (const auto* dielectric = std::get_if<DielectricMaterial>(&material.model)) {
    FillRgb(hits, dielectric->base_color, &t->diffuse);
    FillNumber(hits, dielectric->roughness, &t->width);
  }
}

void ApplyMapT(const TexturedRun& run, MapRole role, HitTextures* t) {
  const Hits hits{run.begin, run.end};
  const bool exponent = std::holds_alternative<PhongFamilyModel>(run.material.model);
  const double widest = exponent ? limits::kExponent.max : 1;
  for (int c = 0; c < 3; ++c) {
    const float* const texels = Channel(t->texels, c);
    switch (role) {
      case MapRole::kDiffuse:
        Multiply(hits, texels, 1, Channel(t->diffuse, c));
        break;
      case MapRole::kSpecular:
        Multiply(hits, texels, 1, Channel(t->specular, c));
        break;
      case MapRole::kSpecularWeight:
        if (c == 0) Multiply(hits, texels, 1, t->exact_dielectric_f90.data());
        break;
      case MapRole::kEmission: {
        const double factor = run.material.emission[c];
        hits.Fill(Channel(t->emission, c),
                  [&](size_t i) { return std::max(factor * double{texels[i]}, 0.0); });
        break;
      }
      case MapRole::kShown: {
        float* const emission = Channel(t->emission, c);
        hits.Fill(emission, [&](size_t i) { return double{emission[i]} * double{texels[i]}; });
        break;
      }
      case MapRole::kWidth:
        if (c == 0) Multiply(hits, texels, widest, t->width.data());
        break;
      case MapRole::kMetallicRoughness:
        if (c == 1) Multiply(hits, texels, 1, t->width.data());
        if (c == 2) Multiply(hits, texels, 1, t->metallic.data());
        break;
    }
  }
}

// Lambert's, and the rough ones.
void FinishMatte(const TexturedRun& run, HitTextures* t) {
  FinishLayers(run, Rgb(1), Rgb(1), t);
  if (const auto* rough = std::get_if<RoughMatteModel>(&run.material.model)) {
    FinishRatio(
        run, [&](size_t) { return rough->roughness; }, t);
  }
  for (int c = 0; c < 3; ++c) {
    double* const diffuse = Channel(t->diffuse, c);
    Hits{run.begin, run.end}.Fill(diffuse, [&](size_t i) { return diffuse[i] * M_1_PI; });
  }
}

void FinishPhong(const TexturedRun& run, const PhongMaterial& phong, HitTextures* t) {
  FinishLayers(run, phong.kd, phong.ka, t);
  const Hits hits{run.begin, run.end};
  const bool radiometric = phong.convention == PhongConvention::kRadiometric;
  const double* const exponents = t->width.data();
  const auto scale = [&](double n) {
    if (!radiometric) return 1.0;
    return phong.model == PhongModel::kBlinnPhong ? BlinnNormalization(n) : PhongNormalization(n);
  };
  const bool one_exponent = !phong.shininess_map.valid();
  const double common = scale(phong.shininess);
  for (size_t i = run.begin; i < run.end; ++i) {
    const double by = one_exponent ? common : scale(exponents[i]);
    t->specular.x[i] *= by;
    t->specular.y[i] *= by;
    t->specular.z[i] *= by;
  }
  hits.Fill(t->alpha.data(), [&](size_t i) { return exponents[i]; });
  for (int c = 0; c < 3; ++c) {
    double* const diffuse = Channel(t->diffuse, c);
    const double kd = phong.kd[c], by = radiometric ? M_1_PI : 1;
    hits.Fill(diffuse, [&](size_t i) { return kd * diffuse[i] * by; });
  }
}

void FinishMaterialT(const TexturedRun& run, HitTextures* t) {
  const Material& material = *run.material.textured;
  if (const auto* phong = std::get_if<PhongMaterial>(&material.model)) {
    FinishPhong(run, *phong, t);
  } else {
    FinishMatte(run, t);
  }
}

// MixCurves of material.cc, times the light.
void MakeTurquinProducts(const MappedProducts& products, int c, HitTextures* t) {
  const double color = products.color[c];
  const double* const dielectric = Channel(t->exact_dielectric_f0, c);
  const double* const metal = Channel(t->exact_metal_f0, c);
  const double *const f90 = t->exact_dielectric_f90.data(), *const metallic = t->metallic.data();
  const float* const not_delta = t->not_delta.data();
  float* HWY_RESTRICT const at_normal = Channel(t->by_turquin_f0, c);
  float* HWY_RESTRICT const rise = Channel(t->by_turquin_rise, c);
  for (size_t i = products.begin; i < products.end; ++i) {
    const double normal =
        (1 - metallic[i]) * dielectric[i] * dielectric[i] + metallic[i] * metal[i] * metal[i];
    const double grazing = (1 - metallic[i]) * dielectric[i] * f90[i] + metallic[i] * metal[i];
    const double light = double{not_delta[i]} * color;
    at_normal[i] = static_cast<float>(normal * light);
    rise[i] = static_cast<float>((grazing - normal) * light);
  }
}

void MakeSchlickProducts(const MappedProducts& products, int c, HitTextures* t) {
  const Hits hits{products.begin, products.end};
  const auto& model = std::get<MicrofacetModel>(products.material.model);
  const double color = products.color[c];
  const float* const not_delta = t->not_delta.data();
  const double* const diffuse = Channel(t->diffuse, c);
  const double *const f0 = Channel(t->specular, c), *const f90 = t->exact_f90.data();
  hits.Fill(Channel(t->by_specular_f0, c),
            [&](size_t i) { return f0[i] * (double{not_delta[i]} * color); });
  hits.Fill(Channel(t->by_specular_rise, c),
            [&](size_t i) { return (f90[i] - f0[i]) * (double{not_delta[i]} * color); });
  if (model.coupling == DiffuseCoupling::kOneMinusFresnel) {
    hits.Fill(Channel(t->by_diffuse_normal, c),
              [&](size_t i) { return (1 - f0[i]) * diffuse[i] * color; });
    hits.Fill(Channel(t->by_diffuse_grazing, c),
              [&](size_t i) { return (1 - f90[i]) * diffuse[i] * color; });
  } else {  // where nobody reads the grazing one
    hits.Fill(Channel(t->by_diffuse_normal, c), [&](size_t i) { return diffuse[i] * color; });
  }
  if (model.compensation == Compensation::kTurquin) MakeTurquinProducts(products, c, t);
}

void MakeMicrofacetProducts(const MappedProducts& products, HitTextures* t) {
  const Hits hits{products.begin, products.end};
  const auto& model = std::get<MicrofacetModel>(products.material.model);
  const float* const not_delta = t->not_delta.data();
  for (int c = 0; c < 3; ++c) {
    const double color = products.color[c];
    if (model.fresnel == FresnelForm::kSchlick) {
      MakeSchlickProducts(products, c, t);
    } else {
      const double* const diffuse = Channel(t->diffuse, c);
      hits.Fill(Channel(t->by_diffuse, c), [&](size_t i) { return diffuse[i] * color; });
      hits.Fill(Channel(t->by_specular, c), [&](size_t i) { return double{not_delta[i]} * color; });
    }
    if (model.compensation == Compensation::kKullaConty) {
      const double* const f_multiple = Channel(t->exact_f_multiple, c);
      hits.Fill(Channel(t->by_multiple, c), [&](size_t i) { return f_multiple[i] * color; });
    }
  }
}

void MakeProductsT(const MappedProducts& products, HitTextures* t) {
  if (std::holds_alternative<MicrofacetModel>(products.material.model)) {
    return MakeMicrofacetProducts(products, t);
  }
  const Hits hits{products.begin, products.end};
  const bool phong = std::holds_alternative<PhongFamilyModel>(products.material.model);
  for (int c = 0; c < 3; ++c) {
    const double color = products.color[c];
    const double* const diffuse = Channel(t->diffuse, c);
    hits.Fill(Channel(t->by_diffuse, c), [&](size_t i) { return diffuse[i] * color; });
    if (!phong) continue;
    const double* const specular = Channel(t->specular, c);
    hits.Fill(Channel(t->by_specular, c), [&](size_t i) { return specular[i] * color; });
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(StartMaterialT);
HWY_EXPORT(ApplyMapT);
HWY_EXPORT(FinishMaterialT);
HWY_EXPORT(MakeProductsT);

void StartMaterial(const TexturedRun& run, HitTextures* textures) {
  HWY_DYNAMIC_DISPATCH(StartMaterialT)(run, textures);
}

void ApplyMap(const TexturedRun& run, MapRole role, HitTextures* textures) {
  HWY_DYNAMIC_DISPATCH(ApplyMapT)(run, role, textures);
}

void FinishMaterial(const TexturedRun& run, HitTextures* textures) {
  if (!HasMappedModel(run.material)) return;
  textures->products_end = 0;  // are of other numbers
  if (std::holds_alternative<MicrofacetModel>(run.material.model)) {
    return FinishMicrofacet(run, textures);
  }
  HWY_DYNAMIC_DISPATCH(FinishMaterialT)(run, textures);
}

void MakeProducts(const MappedProducts& products, HitTextures* textures) {
  HitTextures& t = *textures;
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
