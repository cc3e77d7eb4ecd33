// SPDX-License-Identifier: Apache-2.0
#include "shading/material.h"

#include <algorithm>
#include <cmath>

#include "base/overloaded.h"
#include "brdf/eon.h"
#include "brdf/fresnel.h"
#include "brdf/fresnel_average.h"
#include "brdf/ggx.h"
#include "brdf/multi_scatter.h"
#include "brdf/phong.h"
#include "scene/material_parameters.h"

namespace nacre {
namespace {

// Calls of_channel(c) for each channel.
template <class OfChannel>
Rgb EachChannel(const OfChannel& of_channel) {
  return {of_channel(0), of_channel(1), of_channel(2)};
}

LambertModel MakeModel(const LambertMaterial& material) { return {material.albedo * M_1_PI}; }

Rgb EonRatio(const Rgb& albedo, double roughness) {
  return EachChannel([&](int c) { return EonMultipleRatio(albedo[c], roughness); });
}

RoughMatteModel MakeModel(const OrenNayarMaterial& material) {
  return {.form = DiffuseForm::kOrenNayar,
          .diffuse = material.albedo * M_1_PI,
          .ratio = EonRatio(material.albedo, material.roughness),
          .roughness = material.roughness};
}

RoughMatteModel MakeModel(const BurleyMaterial& material) {
  return {.form = DiffuseForm::kBurley,
          .diffuse = material.albedo * M_1_PI,
          .roughness = material.roughness};
}

PhongFamilyModel MakeModel(const PhongMaterial& material) {
  double diffuse_scale = 1;
  double specular_scale = 1;
  if (material.convention == PhongConvention::kRadiometric) {
    diffuse_scale = M_1_PI;
    specular_scale = material.model == PhongModel::kBlinnPhong
                         ? BlinnNormalization(material.shininess)
                         : PhongNormalization(material.shininess);
  }
  return {.model = material.model,
          .diffuse = material.kd * material.color * diffuse_scale,
          .specular = material.ks * specular_scale,
          .shininess = material.shininess,
          .double_terms = material.shininess > kDoubleTermsShininess};
}

// What all microfacet materials have; the Fresnel curve and the base are the caller's.
template <class Microfacet>
MicrofacetModel MakeLobe(const Microfacet& material) {
  MicrofacetModel model{};
  model.shadowing = material.shadowing;
  model.compensation = material.compensation;
  model.coupling = DiffuseCoupling::kNone;
  model.alpha = AlphaFromRoughness(material.roughness);
  model.schlick_k = SchlickK(material.shadowing, material.roughness);
  model.delta = IsDeltaLobe(model.alpha);
  model.double_terms = IsNarrow(material.roughness, model.alpha);
  model.albedo.lobe = MakeAlbedoFit(material.shadowing, material.roughness);
  return model;
}

// A base that is not Lambert's. EON at roughness 0 is.
template <class Microfacet>
void PrepareBase(const Microfacet& material, MicrofacetModel* model) {
  model->base_roughness = material.diffuse_roughness.value_or(material.roughness);
  model->base_form = material.diffuse;
  if (model->base_form != DiffuseForm::kOrenNayar) return;
  model->base_ratio = EonRatio(material.base_color, model->base_roughness);
  if (model->base_roughness == 0) model->base_form = DiffuseForm::kLambert;
}

// F0 and F90 of the mix, and of Turquin's compensation, from those of dielectric and metal.
void MixCurves(MicrofacetModel* model) {
  const double m = model->metallic, not_metal = 1 - m;
  model->f90 = 1 - (1 - model->dielectric_f90) * not_metal;  // 1, not nearly, of the default
  for (int c = 0; c < 3; ++c) {
    const double dielectric = model->dielectric_f0[c], metal = model->metal_f0[c];
    model->f0[c] = not_metal * dielectric + m * metal;
    model->turquin_f0[c] = not_metal * dielectric * dielectric + m * metal * metal;
    model->turquin_f90[c] = not_metal * dielectric * model->dielectric_f90 + m * metal;
  }
}

// Kulla and Conty 2017: the lobe of what bounced more than once, and, for a reciprocal base, the
// mean albedo that its scale is divided by.
void PrepareKullaConty(const Rgb& dielectric_f_average, const Rgb& metal_f_average,
                       MicrofacetModel* model) {
  const double e_average = model->albedo.lobe.e_average;
  model->dielectric_f_average = dielectric_f_average;
  model->metal_f_average = metal_f_average;
  model->dielectric_f_multiple =
      EachChannel([&](int c) { return KullaContyFresnel(dielectric_f_average[c], e_average); });
  model->f_multiple = EachChannel([&](int c) {
    return (1 - model->metallic) * model->dielectric_f_multiple[c] +
           model->metallic * KullaContyFresnel(metal_f_average[c], e_average);
  });
  model->multiple = KullaContyScale(e_average);
  if (model->coupling != DiffuseCoupling::kAlbedoScaled) return;
  const AlbedoFit& lobe = model->albedo.lobe;
  for (int c = 0; c < 3; ++c) {
    const double f0 = model->dielectric_f0[c];
    const double single = model->fresnel == FresnelForm::kDielectric
                              ? model->albedo.average
                              : f0 * (e_average - lobe.schlick_average) +
                                    model->dielectric_f90 * lobe.schlick_average;
    const double left = 1 - single - model->dielectric_f_multiple[c] * (1 - e_average);
    model->diffuse[c] = left > 0 ? model->diffuse[c] / left : 0;
  }
}

MicrofacetModel MakeModel(const MetallicRoughnessMaterial& material) {
  MicrofacetModel model = MakeLobe(material);
  model.coupling = material.diffuse_coupling;
  model.diffuse = material.base_color * ((1 - material.metallic) * M_1_PI);
  PrepareBase(material, &model);
  model.metallic = material.metallic;
  model.dielectric_f0 = material.dielectric_f0 * material.specular;
  model.dielectric_f90 = material.specular;
  model.metal_f0 = material.base_color;
  MixCurves(&model);
  // Of a material that is no metal the tint does not show.
  const bool tinted = material.metallic > 0 && material.f82_tint != Rgb(1);
  model.fresnel = tinted ? FresnelForm::kF82 : FresnelForm::kSchlick;
  if (tinted) {
    model.f82_slope = EachChannel(
        [&](int c) { return F82SlopeFromTint(material.base_color[c], material.f82_tint[c]); });
  }
  if (model.compensation == Compensation::kKullaConty) {
    PrepareKullaConty(
        EachChannel(
            [&](int c) { return AverageSchlick(model.dielectric_f0[c], model.dielectric_f90); }),
        EachChannel([&](int c) { return AverageF82(model.metal_f0[c], model.f82_slope[c]); }),
        &model);
  }
  return model;
}

MicrofacetModel MakeModel(const ConductorMaterial& material) {
  const double one_minus_seventh = 6.0 / 7;  // of the cosine that the F82 curve goes through
  MicrofacetModel model = MakeLobe(material);
  model.eta = material.eta;
  model.k = material.k;
  model.metallic = 1;
  model.metal_f0 = EachChannel([&](int c) { return FresnelF0(material.eta[c], material.k[c]); });
  MixCurves(&model);
  model.fresnel = FresnelForm::kConductor;
  if (material.fresnel == ConductorFresnel::kF82Tint) {
    model.fresnel = FresnelForm::kF82;
    model.f82_slope = EachChannel([&](int c) {
      return F82Slope(model.metal_f0[c], FresnelConductor(1 - one_minus_seventh, one_minus_seventh,
                                                          material.eta[c], material.k[c]));
    });
  } else if (material.fresnel == ConductorFresnel::kSchlick) {
    model.fresnel = FresnelForm::kSchlick;
  }
  if (model.compensation == Compensation::kKullaConty) {
    PrepareKullaConty(Rgb(0), EachChannel([&](int c) {
                        return model.fresnel == FresnelForm::kConductor
                                   ? AverageConductor(material.eta[c], material.k[c])
                                   : AverageF82(model.metal_f0[c], model.f82_slope[c]);
                      }),
                      &model);
  }
  return model;
}

MicrofacetModel MakeModel(const DielectricMaterial& material) {
  MicrofacetModel model = MakeLobe(material);
  const bool exact = material.fresnel == DielectricFresnel::kExact;
  model.coupling = material.diffuse_coupling;
  model.diffuse = material.base_color * M_1_PI;
  PrepareBase(material, &model);
  model.eta = Rgb(material.ior);
  model.dielectric_f0 = Rgb(FresnelF0(material.ior, 0.0));
  MixCurves(&model);
  model.fresnel = exact ? FresnelForm::kDielectric : FresnelForm::kSchlick;
  if (exact) {
    model.albedo = MakeDielectricAlbedoFit(material.shadowing, material.roughness, material.ior);
    if (material.roughness_map.valid()) {
      model.curves = std::make_shared<const DielectricCurves>(
          MakeDielectricCurves(material.shadowing, material.ior));
    }
  }
  if (model.compensation == Compensation::kKullaConty) {
    PrepareKullaConty(Rgb(exact ? AverageDielectric(material.ior) : AverageSchlick(model.f0.x)),
                      Rgb(0), &model);
  }
  return model;
}

}  // namespace

namespace {

void FindMaps(const Material& material, ShadingMaterial* prepared) {
  if (const MaterialModel* const model = ModelOf(material)) {
    prepared->mapped =
        std::any_of(model->maps.begin(), model->maps.end(), [&](const MaterialMap& map) {
          return map.use != MapUse::kOpacity && map.get(material).valid();
        });
  }
  prepared->mapped = prepared->mapped || material.vertex_colors != VertexColors::kNone;
  prepared->turned = material.normal_map.texture.valid() || material.bump_map.texture.valid();
  if (prepared->mapped || prepared->turned) prepared->textured = &material;
}

// A metal's base reflects nothing, whatever share of the light it would get: an albedo need not be
// asked for it. What Fresnel's curve leaves is at hand, and kernels of most materials take it.
void SkipBlackBase(ShadingMaterial* prepared) {
  auto* const model = std::get_if<MicrofacetModel>(&prepared->model);
  if (model == nullptr || prepared->mapped || model->diffuse != Rgb(0)) return;
  if (model->coupling == DiffuseCoupling::kAlbedoScaled) model->coupling = DiffuseCoupling::kNone;
  model->base_form = DiffuseForm::kLambert;
}

}  // namespace

ShadingMaterial PrepareMaterial(const Material& material, const Rgb& ambient_radiance) {
  ShadingMaterial prepared{};
  prepared.emission = material.emission;
  Rgb of_ambient(0, 0, 0);  // what it reflects of light from everywhere
  std::visit(Overloaded{[&](const LambertMaterial& lambert) {
                          prepared.model = MakeModel(lambert);
                          prepared.albedo = of_ambient = lambert.albedo;
                        },
                        [&](const OrenNayarMaterial& rough) {
                          prepared.model = MakeModel(rough);
                          prepared.albedo = of_ambient = rough.albedo;
                        },
                        [&](const BurleyMaterial& burley) {
                          prepared.model = MakeModel(burley);
                          prepared.albedo = of_ambient = burley.albedo;
                        },
                        [&](const PhongMaterial& phong) {
                          prepared.model = MakeModel(phong);
                          prepared.albedo = phong.color * phong.kd;
                          of_ambient = phong.color * phong.ka;
                        },
                        [&](const MetallicRoughnessMaterial& metallic_roughness) {
                          prepared.model = MakeModel(metallic_roughness);
                          // base_color is what both the diffuse base and a metal reflect. The
                          // gloss of a dielectric is left out, as lessons do.
                          prepared.albedo = of_ambient = metallic_roughness.base_color;
                        },
                        [&](const ConductorMaterial& conductor) {
                          const MicrofacetModel model = MakeModel(conductor);
                          prepared.model = model;
                          prepared.albedo = model.f0;
                          of_ambient = EachChannel([&](int c) {
                            return AverageConductor(conductor.eta[c], conductor.k[c]);
                          });
                        },
                        [&](const DielectricMaterial& dielectric) {
                          const double gloss = AverageDielectric(dielectric.ior);
                          prepared.model = MakeModel(dielectric);
                          prepared.albedo = dielectric.base_color;
                          of_ambient = Rgb(gloss) + dielectric.base_color * (1 - gloss);
                        },
                        [](const SplitMaterial&) {}},
             material.model);
  prepared.ambient = of_ambient * ambient_radiance;
  prepared.ambient_radiance = ambient_radiance;
  FindMaps(material, &prepared);
  SkipBlackBase(&prepared);
  if (auto* microfacet = std::get_if<MicrofacetModel>(&prepared.model)) {
    microfacet->prepared = microfacet->compensation != Compensation::kNone ||
                           microfacet->coupling == DiffuseCoupling::kAlbedoScaled;
  }
  return prepared;
}

double CoverAlbedo(const MicrofacetModel& model, double n_dot_v, int channel) {
  const double f0 = model.dielectric_f0[channel];
  const double one = AlbedoOne(model.albedo.lobe, n_dot_v);
  const double loss = AlbedoLoss(model.albedo.lobe, n_dot_v);
  const double schlick = AlbedoSchlick(model.albedo.lobe, n_dot_v);
  const double single = model.fresnel == FresnelForm::kDielectric
                            ? AlbedoFresnel(model.albedo, n_dot_v)
                            : f0 * (one - schlick) + model.dielectric_f90 * schlick;
  switch (model.compensation) {
    case Compensation::kTurquin:
      return single * (1 + f0 * loss / one);
    case Compensation::kKullaConty:
      return single + model.dielectric_f_multiple[channel] * loss;
    case Compensation::kNone:
      break;
  }
  return single;
}

bool HasDoubleTerms(const ShadingMaterial& material) {
  if (material.textured != nullptr) return true;  // mappings start from the exact normal, too
  return std::visit(
      Overloaded{[](const PhongFamilyModel& phong) { return phong.double_terms; },
                 [](const MicrofacetModel& microfacet) { return microfacet.double_terms; },
                 [](const auto&) { return false; }},
      material.model);
}

bool HasDeltaLobe(const ShadingMaterial& material) {
  const auto* microfacet = std::get_if<MicrofacetModel>(&material.model);
  return microfacet != nullptr && microfacet->delta && microfacet->f90 > 0;
}

}  // namespace nacre
