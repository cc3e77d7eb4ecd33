// SPDX-License-Identifier: Apache-2.0
#include "shading/shade.h"

#include <algorithm>
#include <type_traits>
#include <variant>

#include "base/overloaded.h"
#include "shading/derive.h"
#include "shading/kernels.h"
#include "shading/measured_model.h"
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

MatteConstants<float> NumbersOfModel(const MatteModel& model) {
  MatteConstants<float> constants;
  Assign(model.ratio, constants.ratio);
  constants.roughness = static_cast<float>(model.roughness);
  return constants;
}
PhongConstants<float> NumbersOfModel(const PhongFamilyModel& model) {
  return {static_cast<float>(model.shininess)};
}

template <class Model>
auto NumbersOfHits(const Model&, const LitHits& lit) {
  return ColumnsIn<typename Model::template Constants<float*>>(lit.textures->constants);
}
MicrofacetNumbers<float*> NumbersOfHits(const MicrofacetModel&, const LitHits& lit) {
  return nacre::NumbersOfHits(lit.material, *lit.textures);
}

// Shade runs the kernel of a model. The constants, and `light`, their products with the light, are
// shared by all hits or belong to each hit.
template <class Number>
void Shade(const MatteModel& model, const MatteConstants<Number>& constants,
           const MatteLight<Number>& light, const LitHits& lit, ShadeScratch*) {
  ShadeMatte(MatteUniforms<Number>{model.form, constants, light}, lit);
}

template <class Number>
void Shade(const PhongFamilyModel& model, const PhongConstants<Number>& constants,
           const PhongLight<Number>& light, const LitHits& lit, ShadeScratch* scratch) {
  const SharpLobeTerms* const sharp = FormSharpTerms(model, lit, &scratch->sharp);
  ShadePhong(PhongUniforms<Number>{model.model, constants, light, sharp}, lit);
}

template <class Number>
void Shade(const MicrofacetModel& model, const MicrofacetNumbers<Number>& numbers,
           const MicrofacetLight<Number>& light, const LitHits& lit, ShadeScratch* scratch) {
  MicrofacetUniforms<Number> uniforms{numbers, light};
  Assign(model.eta, uniforms.eta);
  Assign(model.k, uniforms.k);
  const SharpLobeTerms* const sharp = FormSharpTerms(model, lit, &scratch->sharp);
  if (sharp != nullptr) uniforms.sharp_distribution = sharp->distribution.data();
  if (sharp != nullptr && model.anisotropic) {
    uniforms.light_root = sharp->light_root.data();
    uniforms.view_root = sharp->view_root.data();
    uniforms.t_dot_l = sharp->t_dot_l.data();
    uniforms.b_dot_l = sharp->b_dot_l.data();
  }
  if (model.base_form != DiffuseForm::kLambert) {
    SpreadBase(model.base_form, numbers.base.roughness, lit, &scratch->base);
    uniforms.spread = &scratch->base;
  }
  ShadeMicrofacet(uniforms, lit);
}

}  // namespace

const SharpLobeTerms* FormSharpTerms(const PhongFamilyModel& model, const LitHits& lit,
                                     SharpLobeTerms* terms) {
  const HitParameters* const maps = lit.Maps();
  if (maps == nullptr) {
    if (!model.double_terms) return nullptr;
    FormSharpPhong(model.model, model.shininess, lit, terms);
    return terms;
  }
  const double* const exponents = NumbersOf(*maps, MappedNumber::kWidth);
  const auto is_sharp = [](double n) { return n > kDoubleTermsShininess; };
  if (std::none_of(exponents + lit.begin, exponents + lit.end, is_sharp)) return nullptr;
  FormSharpPhong(model.model, exponents, lit, terms);
  return terms;
}

const SharpLobeTerms* FormSharpTerms(const MicrofacetModel& model, const LitHits& lit,
                                     SharpLobeTerms* terms) {
  const HitParameters* const maps = lit.Maps();
  if (model.anisotropic) {
    FormAnisotropicGgx(LobesOf(lit.material, model, maps), lit, terms);
    return terms;
  }
  if (maps == nullptr) {
    if (!model.double_terms) return nullptr;
    FormSharpGgx(model.alpha, lit, terms);
    return terms;
  }
  const double* const alpha = maps->sharp_alpha.data();
  const auto is_sharp = [](double a) { return a >= 0; };
  if (std::none_of(alpha + lit.begin, alpha + lit.end, is_sharp)) return nullptr;
  FormSharpGgx(alpha, lit, terms);
  return terms;
}

void PrepareRun(const ShadingMaterial& material, size_t begin, size_t end, Surface* surface,
                const HitParameters* textures) {
  const auto* microfacet = std::get_if<MicrofacetModel>(&material.model);
  if (microfacet == nullptr || !microfacet->prepared) return;
  if (!material.by_hit.model) {
    return PrepareMicrofacet(NumbersOfModel(*microfacet), begin, end, surface);
  }
  PrepareMicrofacet(NumbersOfHits(material, *textures), begin, end, surface);
}

void ShadeRun(const LitHits& lit, ShadeScratch* scratch) {
  const auto shade = [&]<class Model>(const Model& model) {
    if (lit.Maps() == nullptr) {
      return Shade(model, NumbersOfModel(model), MakeLight(model, lit.light.color), lit, scratch);
    }
    MakeProducts(lit);
    const auto light = ColumnsIn<typename Model::template Light<float*>>(lit.textures->products);
    Shade(model, NumbersOfHits(model, lit), light, lit, scratch);
  };
  std::visit(Overloaded{[](std::monostate) {},
                        [&](const UserModel& model) { ShadeUser(model, lit, scratch); },
                        [&](const MeasuredModel& model) { ShadeMeasured(model, lit); }, shade},
             lit.material.model);
  for (const LayerModel& layer : lit.material.layers) {
    if (!LiesOverCoats(layer)) CoverByLayer(layer, lit);
  }
}

}  // namespace nacre
