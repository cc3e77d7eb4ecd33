// SPDX-License-Identifier: Apache-2.0
#include "shading/shade.h"

#include <algorithm>
#include <type_traits>
#include <variant>

#include "base/overloaded.h"
#include "shading/derive.h"
#include "shading/kernels.h"
#include "shading/mapped.h"
#include "shading/models_at_hit.h"
#include "shading/user_model.h"

namespace nacre {
namespace {

void Assign(const Rgb& from, float (&to)[3]) {
  for (int c = 0; c < 3; ++c) to[c] = static_cast<float>(from[c]);
}

MatteLight<float> MakeLight(const MatteModel& model, const Rgb& color) {
  MatteLight<float> light;
  Assign(model.diffuse * color, light.diffuse);
  return light;
}

PhongLight<float> MakeLight(const PhongFamilyModel& model, const Rgb& color) {
  PhongLight<float> light;
  Assign(model.diffuse * color, light.diffuse);
  Assign(model.specular * color, light.specular);
  return light;
}

// Computes only the products that the model's curve and compensation need: a batch has few hits of
// each material.
MicrofacetLight<float> MakeLight(const MicrofacetModel& model, const Rgb& color) {
  MicrofacetLight<float> light;
  const double not_delta = model.delta ? 0 : 1;
  const bool kulla_conty = model.compensation == Compensation::kKullaConty;
  for (int c = 0; c < 3; ++c) {
    const double specular = not_delta * color[c];
    if (model.fresnel == FresnelForm::kSchlick) {
      const MicrofacetColors at = ColorsOf(model, c);
      PutSchlickLight(TimesLight(model, at, at.diffuse, color[c], not_delta), c, Rounded(), &light);
      if (model.compensation == Compensation::kTurquin) {
        PutTurquinLight(at, specular, c, Rounded(), &light);
      }
    } else {
      light.diffuse[c] = static_cast<float>(model.diffuse[c] * color[c]);
      light.specular[c] = static_cast<float>(specular);
    }
    if (kulla_conty) light.multiple[c] = static_cast<float>(model.f_multiple[c] * color[c]);
  }
  return light;
}

// The maps of a run of hits.
struct RunMaps {
  const HitParameters* textures = nullptr;  // null unless hits have constants of their own
  bool widths = false;                      // ShadingMaterial::by_hit.width
};

// ShadeByModel runs the kernel of a model. `constants`, and `light`, their products with the light,
// are shared by all hits or belong to each hit.
template <class Number>
void ShadeByModel(const MatteModel& model, const MatteConstants<Number>& constants,
                  const MatteLight<Number>& light, const ShadeRange& range, const RunMaps&,
                  ShadeScratch*) {
  ShadeMatte(MatteUniforms<Number>{model.form, constants, light}, range);
}

template <class Number>
void ShadeByModel(const PhongFamilyModel& model, const PhongConstants<Number>& constants,
                  const PhongLight<Number>& light, const ShadeRange& range, const RunMaps& maps,
                  ShadeScratch* scratch) {
  const SharpLobeTerms* const sharp = FormSharpTerms(model, range, maps.textures, &scratch->sharp);
  ShadePhong(PhongUniforms<Number>{model.model, constants, light, sharp}, range);
}

template <class Number>
void ShadeByCurve(const MicrofacetUniforms<Number>& uniforms, const ShadeRange& range) {
  switch (uniforms.model->fresnel) {
    case FresnelForm::kSchlick:
      return ShadeSchlick(uniforms, range);
    case FresnelForm::kF82:
      return ShadeF82(uniforms, range);
    case FresnelForm::kDielectric:
      return ShadeDielectric(uniforms, range);
    case FresnelForm::kConductor:
      return ShadeConductor(uniforms, range);
  }
}

template <class Number>
void ShadeByModel(const MicrofacetModel& model, const MicrofacetConstants<Number>& constants,
                  const MicrofacetLight<Number>& light, const ShadeRange& range,
                  const RunMaps& maps, ShadeScratch* scratch) {
  MicrofacetUniforms<Number> uniforms{constants, &model, light};
  Assign(model.eta, uniforms.eta);
  Assign(model.k, uniforms.k);
  const SharpLobeTerms* const sharp = FormSharpTerms(model, range, maps.textures, &scratch->sharp);
  if (sharp != nullptr) uniforms.sharp_distribution = sharp->distribution.data();
  if (maps.widths) uniforms.fit = maps.textures->fit.data();
  uniforms.fit_stride = HitParameters::kStride;
  if (model.base_form != DiffuseForm::kLambert) {
    SpreadBase(model.base_form, constants.base.roughness, range, &scratch->base);
    uniforms.spread = &scratch->base;
  }
  ShadeByCurve(uniforms, range);
}

MatteConstants<float> ConstantsOf(const MatteModel& model) {
  MatteConstants<float> constants;
  Assign(model.ratio, constants.ratio);
  constants.roughness = static_cast<float>(model.roughness);
  return constants;
}
PhongConstants<float> ConstantsOf(const PhongFamilyModel& model) {
  return {static_cast<float>(model.shininess)};
}
const MicrofacetConstants<float>& ConstantsOf(const MicrofacetModel& model) {
  return model.constants;
}

// Shades hits that share the constants of their material.
template <class Model>
void Shade(const Model& model, const ShadeRange& range, ShadeScratch* scratch) {
  ShadeByModel(model, ConstantsOf(model), MakeLight(model, range.light.color), range, {}, scratch);
}

// Shades hits with constants of their own.
template <template <class> class Constants, template <class> class Light, class Model>
void ShadeMapped(const ShadingMaterial& material, const Model& model, const ShadeRange& range,
                 ShadeScratch* scratch, HitParameters* maps) {
  MakeProducts({material, range.light.color, range.begin, range.end}, maps);
  ShadeByModel(model, ColumnsIn<Constants<float*>>(maps->constants),
               ColumnsIn<Light<float*>>(maps->products), range, {maps, material.by_hit.width},
               scratch);
}

}  // namespace

const SharpLobeTerms* FormSharpTerms(const PhongFamilyModel& model, const ShadeRange& range,
                                     const HitParameters* maps, SharpLobeTerms* terms) {
  if (maps == nullptr) {
    if (!model.double_terms) return nullptr;
    FormSharpPhong(model.model, range, terms);
    return terms;
  }
  const double* const exponents = NumbersOf(*maps, MappedNumber::kWidth);
  const auto is_sharp = [](double n) { return n > kDoubleTermsShininess; };
  if (std::none_of(exponents + range.begin, exponents + range.end, is_sharp)) return nullptr;
  FormSharpPhong(model.model, exponents, range, terms);
  return terms;
}

const SharpLobeTerms* FormSharpTerms(const MicrofacetModel& model, const ShadeRange& range,
                                     const HitParameters* maps, SharpLobeTerms* terms) {
  if (maps == nullptr) {
    if (!model.double_terms) return nullptr;
    FormSharpGgx(model.alpha, range, terms);
    return terms;
  }
  const double* const alpha = maps->sharp_alpha.data();
  const auto is_sharp = [](double a) { return a >= 0; };
  if (std::none_of(alpha + range.begin, alpha + range.end, is_sharp)) return nullptr;
  FormSharpGgx(alpha, range, terms);
  return terms;
}

void PrepareRun(const ShadingMaterial& material, size_t begin, size_t end, Surface* surface,
                const HitParameters* textures) {
  const auto* microfacet = std::get_if<MicrofacetModel>(&material.model);
  if (microfacet == nullptr || !microfacet->prepared) return;
  if (!material.by_hit.model) {
    PrepareMicrofacet(PrepareUniforms<float>{microfacet->constants, *microfacet, nullptr, 0}, begin,
                      end, surface);
    return;
  }
  const float* const fit = material.by_hit.width ? textures->fit.data() : nullptr;
  PrepareMicrofacet(
      PrepareUniforms<float*>{ColumnsIn<MicrofacetConstants<float*>>(textures->constants),
                              *microfacet, fit, HitParameters::kStride},
      begin, end, surface);
}

namespace {

// Shades a material without its layers.
void ShadeModel(const ShadingMaterial& material, const ShadeRange& range, ShadeScratch* scratch,
                HitParameters* maps) {
  if (!material.by_hit.model) {
    std::visit(Overloaded{[](std::monostate) {},
                          [&](const UserModel& model) { ShadeUser(model, range, scratch); },
                          [&](const auto& model) { Shade(model, range, scratch); }},
               material.model);
    return;
  }
  std::visit(
      Overloaded{[](std::monostate) {},
                 [&](const UserModel& model) { ShadeUser(model, range, scratch); },
                 [&](const MatteModel& model) {
                   ShadeMapped<MatteConstants, MatteLight>(material, model, range, scratch, maps);
                 },
                 [&](const PhongFamilyModel& model) {
                   ShadeMapped<PhongConstants, PhongLight>(material, model, range, scratch, maps);
                 },
                 [&](const MicrofacetModel& model) {
                   ShadeMapped<MicrofacetConstants, MicrofacetLight>(material, model, range,
                                                                     scratch, maps);
                 }},
      material.model);
}

}  // namespace

void ShadeRun(const ShadingMaterial& material, const LitHits& lit, size_t begin, size_t end,
              ShadeScratch* scratch, ReflectedRadiance* radiance) {
  const ShadeRange range{lit.hits, lit.surface, lit.light, lit.on_hits,
                         begin,    end,         radiance,  lit.components};
  ShadeModel(material, range, scratch, lit.textures);
  for (const LayerModel& layer : material.layers) {
    CoverByLayer(layer, material.by_hit.model ? lit.textures : nullptr, range);
  }
}

}  // namespace nacre
