// SPDX-License-Identifier: Apache-2.0
#include "shading/shade.h"

#include <algorithm>
#include <array>
#include <type_traits>
#include <variant>

#include "base/overloaded.h"
#include "shading/derive.h"
#include "shading/hit_parameters.h"
#include "shading/kernels.h"
#include "shading/mapped.h"

namespace nacre {
namespace {

// Lights that one call of a kernel shades by. More make several calls, with the same bits: sums
// between calls are kept in the floats that they are formed in.
constexpr size_t kLightsAtOnce = 16;

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

// What the model's curve and compensation ask for alone: a batch has few hits of each material.
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

// Of hits with constants of their own; else `textures` is null.
struct RunMaps {
  const HitTextures* textures = nullptr;
  bool widths = false;  // ShadingMaterial::mapped_width
};

// By the kernel of a model, whose constants are all hits' or each hit's. `lights` are those of the
// range.
template <class Number>
void ShadeGroup(const MatteModel& model, const MatteConstants<Number>& constants,
                const MatteLight<Number>* lights, const ShadeRange& range, const RunMaps&,
                ShadeScratch*) {
  ShadeMatte(MatteUniforms<Number>{model.form, constants, lights}, range);
}

template <class Number>
void ShadeGroup(const PhongFamilyModel& model, const PhongConstants<Number>& constants,
                const PhongLight<Number>* lights, const ShadeRange& range, const RunMaps& maps,
                ShadeScratch* scratch) {
  const SharpLobeTerms* const sharp = FormSharpTerms(model, range, maps.textures, &scratch->sharp);
  ShadePhong(PhongUniforms<Number>{model.model, constants, lights, sharp}, range);
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
void ShadeGroup(const MicrofacetModel& model, const MicrofacetConstants<Number>& constants,
                const MicrofacetLight<Number>* lights, const ShadeRange& range, const RunMaps& maps,
                ShadeScratch* scratch) {
  MicrofacetUniforms<Number> uniforms{constants, &model, lights};
  if constexpr (std::is_same_v<Number, float>) {
    const auto& f0 = constants.f0;
    uniforms.is_bright = std::min({f0[0], f0[1], f0[2]}) >= kBrightF0;
  }
  Assign(model.eta, uniforms.eta);
  Assign(model.k, uniforms.k);
  const SharpLobeTerms* const sharp = FormSharpTerms(model, range, maps.textures, &scratch->sharp);
  if (sharp != nullptr) uniforms.sharp_distribution = sharp->distribution.data();
  if (maps.widths) uniforms.fit = maps.textures->fit.data();
  uniforms.fit_stride = HitTextures::kStride;
  if (model.base_form != DiffuseForm::kLambert) {
    SpreadBase(model.base_form, constants.base.roughness, range, &scratch->base);
    uniforms.spread = &scratch->base;
  }
  ShadeByCurve(uniforms, range);
}

// Whether a kernel has room for the terms of one light only.
bool TakesOneLight(const MatteModel&) { return false; }
bool TakesOneLight(const PhongFamilyModel& model) { return model.double_terms; }
bool TakesOneLight(const MicrofacetModel& model) {
  return model.double_terms || model.base_form != DiffuseForm::kLambert;
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

// The part of a range under some of its lights, those before which have been shaded by.
ShadeRange Under(const ShadeRange& range, size_t first, size_t count) {
  ShadeRange group = range;
  group.lights = range.lights.subspan(first, count);
  if (first > 0) group.output = OutputMode::kAccumulate;
  return group;
}

// Hits that share the constants of their material.
template <class Model>
void Shade(const Model& model, const ShadeRange& range, ShadeScratch* scratch) {
  const size_t at_once = TakesOneLight(model) ? 1 : kLightsAtOnce;
  const auto& constants = ConstantsOf(model);
  std::array<decltype(MakeLight(model, Rgb())), kLightsAtOnce> lights;
  for (size_t first = 0; first < range.lights.size(); first += at_once) {
    const size_t count = std::min(at_once, range.lights.size() - first);
    for (size_t k = 0; k < count; ++k) {
      lights[k] = MakeLight(model, range.lights[first + k].light->color);
    }
    ShadeGroup(model, constants, lights.data(), Under(range, first, count), {}, scratch);
  }
}

// Hits with constants of their own, one light after the other.
template <template <class> class Constants, template <class> class Light, class Model>
void ShadeMapped(const ShadingMaterial& material, const Model& model, const ShadeRange& range,
                 ShadeScratch* scratch, HitTextures* maps) {
  const auto constants = ColumnsIn<Constants<float*>>(maps->constants);
  const auto products = ColumnsIn<Light<float*>>(maps->products);
  const RunMaps run{maps, material.mapped_width};
  for (size_t k = 0; k < range.lights.size(); ++k) {
    MakeProducts({material, range.lights[k].light->color, range.begin, range.end}, maps);
    ShadeGroup(model, constants, &products, Under(range, k, 1), run, scratch);
  }
}

}  // namespace

const SharpLobeTerms* FormSharpTerms(const PhongFamilyModel& model, const ShadeRange& range,
                                     const HitTextures* maps, SharpLobeTerms* terms) {
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
                                     const HitTextures* maps, SharpLobeTerms* terms) {
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

bool EvaluatedInPlace(const ShadingLight& light) {
  return light.form == LightForm::kDirectional || light.form == LightForm::kInverseSquare;
}

void PrepareRun(const ShadingMaterial& material, size_t begin, size_t end, Surface* surface,
                const HitTextures* textures) {
  const auto* microfacet = std::get_if<MicrofacetModel>(&material.model);
  if (microfacet == nullptr || !microfacet->prepared) return;
  if (!material.mapped_model) {
    PrepareMicrofacet(PrepareUniforms<float>{microfacet->constants, *microfacet, nullptr, 0}, begin,
                      end, surface);
    return;
  }
  const float* const fit = material.mapped_width ? textures->fit.data() : nullptr;
  PrepareMicrofacet(
      PrepareUniforms<float*>{ColumnsIn<MicrofacetConstants<float*>>(textures->constants),
                              *microfacet, fit, HitTextures::kStride},
      begin, end, surface);
}

namespace {

// All but the layers.
void ShadeModel(const ShadingMaterial& material, const ShadeRange& range, ShadeScratch* scratch,
                HitTextures* maps) {
  if (!material.mapped_model) {
    std::visit(
        Overloaded{[](std::monostate) {}, [&](const auto& model) { Shade(model, range, scratch); }},
        material.model);
    return;
  }
  std::visit(
      Overloaded{[](std::monostate) {},
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

// One light after the other, as what layers leave of it depends on where it is. The model's
// reflection is overwritten layer by layer, and the last layer's goes where the range says.
void ShadeUnderLayers(const ShadingMaterial& material, const ShadeRange& range,
                      ShadeScratch* scratch, HitTextures* maps) {
  if (!scratch->below) scratch->below = std::make_unique<BelowLayers>();
  BelowLayers& below = *scratch->below;
  const HitTextures* const layer_maps = material.mapped_model ? maps : nullptr;
  for (size_t k = 0; k < range.lights.size(); ++k) {
    LightOnBatch light = range.lights[k];
    if (light.evaluated == nullptr) {
      EvaluateLight(*light.light, range.hits, range.surface, &below.light);
      light.evaluated = &below.light;
    }
    ShadeRange all = Under(range, k, 1);
    all.lights = {&light, 1};
    ShadeRange under = all;
    under.radiance = &below.radiance;
    under.output = OutputMode::kOverwrite;
    ShadeModel(material, under, scratch, maps);
    for (const LayerModel& layer : material.layers) {
      const bool is_top = &layer == &material.layers.back();
      CoverByLayer(layer, layer_maps, is_top ? all : under, below.radiance);
    }
  }
}

}  // namespace

void ShadeRun(const ShadingMaterial& material, const LitHits& lit, size_t begin, size_t end,
              ShadeScratch* scratch, ReflectedRadiance* radiance) {
  const ShadeRange range{lit.hits, lit.surface, lit.lights, begin, end, radiance, lit.output};
  if (!material.layers.empty()) {
    return ShadeUnderLayers(material, range, scratch, lit.textures);
  }
  ShadeModel(material, range, scratch, lit.textures);
}

void ClearSoa(size_t count, Soa3<float>* soa) {
  std::fill_n(soa->x.data(), count, 0.0f);
  std::fill_n(soa->y.data(), count, 0.0f);
  std::fill_n(soa->z.data(), count, 0.0f);
}

void ClearRadiance(size_t count, ReflectedRadiance* radiance) {
  ClearSoa(count, &radiance->diffuse);
  ClearSoa(count, &radiance->specular);
  ClearSoa(count, &radiance->sum);
}

}  // namespace nacre
