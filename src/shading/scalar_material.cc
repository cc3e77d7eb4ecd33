// SPDX-License-Identifier: Apache-2.0
#include "shading/scalar_material.h"

#include <cmath>

#include "base/overloaded.h"
#include "brdf/burley.h"
#include "brdf/eon.h"
#include "brdf/fresnel.h"
#include "brdf/ggx.h"
#include "brdf/multi_scatter.h"
#include "brdf/phong.h"
#include "shading/user_model.h"

namespace nacre {
namespace {

// A diffuse model's reflection over Lambert's. `ratio` is EonMultipleRatio of the channel's colour.
double SpreadOf(DiffuseForm form, const Angles<double>& a, double roughness, double ratio) {
  switch (form) {
    case DiffuseForm::kOrenNayar:
      return M_PI * (EonSingle(a.n_dot_l, a.n_dot_v, 1 - a.lv_squared / 2, roughness) +
                     ratio * EonMultiple(a.n_dot_l, a.n_dot_v, roughness));
    case DiffuseForm::kBurley:
      return M_PI * BurleyDiffuse(a, roughness);
    case DiffuseForm::kLambert:
      break;
  }
  return 1;
}

Reflection ReflectModel(const MatteModel& model, const Vec3d& n, const Vec3d& l, const Vec3d& v) {
  const Angles<double> a = ComputeAngles(n, l, v);
  Reflection out;
  for (int c = 0; c < 3; ++c) {
    out.diffuse[c] =
        model.diffuse[c] * a.n_dot_l * SpreadOf(model.form, a, model.roughness, model.ratio[c]);
  }
  return out;
}

Reflection ReflectModel(const PhongFamilyModel& model, const Vec3d& n, const Vec3d& l,
                        const Vec3d& v) {
  const double n_dot_l = n ^ l;
  const double lobe = model.model == PhongModel::kBlinnPhong
                          ? BlinnLobe(ComputeAngles(n, l, v), model.shininess)
                          : PhongLobe(n, l, v, model.shininess);
  const double weight = model.model == PhongModel::kModifiedPhong ? n_dot_l : 1;
  return {model.diffuse * n_dot_l, model.specular * (lobe * weight)};
}

// Fresnel's term of dielectric and metal for one channel, each times its share of the mix.
struct FresnelShares {
  double dielectric = 0, metal = 0;
};

FresnelShares SharesOf(const MicrofacetModel& model, double v_dot_h, double one_minus_vh, int c) {
  const double metallic = model.metallic;
  switch (model.fresnel) {
    case FresnelForm::kSchlick:
    case FresnelForm::kF82:
      return {(1 - metallic) * FresnelSchlick(model.dielectric_f0[c], model.dielectric_f90,
                                              Power5(one_minus_vh)),
              metallic * FresnelF82(v_dot_h, one_minus_vh, model.metal_f0[c], model.f82_slope[c])};
    case FresnelForm::kDielectric:
      return {.dielectric = FresnelDielectric(v_dot_h, one_minus_vh, model.eta[c])};
    case FresnelForm::kConductor:
      return {.metal = FresnelConductor(v_dot_h, one_minus_vh, model.eta[c], model.k[c])};
  }
  return {};
}

// The fraction of the light of channel c that reaches the base and leaves it again.
double BaseShare(const MicrofacetModel& model, const Angles<double>& a, double fresnel, int c) {
  switch (model.coupling) {
    case DiffuseCoupling::kAlbedoScaled: {
      const double out = 1 - CoverAlbedo(model, a.n_dot_v, c);
      const bool reciprocal = model.compensation == Compensation::kKullaConty;
      return reciprocal ? out * (1 - CoverAlbedo(model, a.n_dot_l, c)) : out;
    }
    case DiffuseCoupling::kOneMinusFresnel:
      return 1 - fresnel;
    case DiffuseCoupling::kNone:
      break;
  }
  return 1;
}

Reflection ReflectModel(const MicrofacetModel& model, const Vec3d& n, const Vec3d& l,
                        const Vec3d& v) {
  const Angles<double> a = ComputeAngles(n, l, v);
  const Rgb fresnel = FresnelOf(model, VDotH(a), OneMinusVDotH(a));
  const Rgb turquin = TurquinTerm(model, VDotH(a), OneMinusVDotH(a));
  const double lobe = GgxDistribution(a, model.alpha) * VisibilityOf(model, a.n_dot_l, a.n_dot_v);
  const double loss_v = AlbedoLoss(model.albedo.lobe, a.n_dot_v);
  const double loss_l = AlbedoLoss(model.albedo.lobe, a.n_dot_l);
  Reflection out;
  for (int c = 0; c < 3; ++c) {
    double specular = fresnel[c] * lobe;
    if (model.compensation == Compensation::kTurquin) {
      specular += turquin[c] * lobe * loss_v / (1 - loss_v);
    } else if (model.compensation == Compensation::kKullaConty) {
      specular += model.f_multiple[c] * model.multiple * loss_v * loss_l;
    }
    out.specular[c] = specular * a.n_dot_l;
    const double spread = SpreadOf(model.base_form, a, model.base_roughness, model.base_ratio[c]);
    out.diffuse[c] = BaseShare(model, a, fresnel[c], c) * model.diffuse[c] * spread * a.n_dot_l;
  }
  return out;
}

Reflection ReflectModel(const UserModel& model, const Vec3d& n, const Vec3d& l, const Vec3d& v) {
  return ReflectUser(model, n, l, v);
}

}  // namespace

Reflection Reflect(const ShadingMaterial& material, const Vec3d& normal, const Vec3d& to_light,
                   const Vec3d& to_view) {
  if (!((normal ^ to_light) > 0) || !((normal ^ to_view) > 0)) return {};
  Reflection reflection = std::visit(
      Overloaded{[](const std::monostate&) { return Reflection{}; },
                 [&](const auto& model) { return ReflectModel(model, normal, to_light, to_view); }},
      material.model);
  const Angles<double> angles = ComputeAngles(normal, to_light, to_view);
  for (const LayerModel& layer : material.layers) {
    const LayerReflection of_layer = EvaluateLayer(layer, angles);
    reflection.diffuse = reflection.diffuse * of_layer.below + of_layer.lobe;
    reflection.specular = reflection.specular * of_layer.below;
  }
  if (!material.coat) return reflection;
  const Rgb left = LeftByCoat(*material.coat, normal ^ to_view);
  const Reflection coat = Reflect(*material.coat, normal, to_light, to_view);
  return {reflection.diffuse * left, reflection.specular * left + coat.specular};
}

Rgb FresnelOf(const MicrofacetModel& model, double v_dot_h, double one_minus_vh) {
  Rgb fresnel;
  for (int c = 0; c < 3; ++c) {
    const auto [dielectric, metal] = SharesOf(model, v_dot_h, one_minus_vh, c);
    fresnel[c] = dielectric + metal;
  }
  return fresnel;
}

Rgb TurquinTerm(const MicrofacetModel& model, double v_dot_h, double one_minus_vh) {
  Rgb term;
  for (int c = 0; c < 3; ++c) {
    const auto [dielectric, metal] = SharesOf(model, v_dot_h, one_minus_vh, c);
    term[c] = model.dielectric_f0[c] * dielectric + model.metal_f0[c] * metal;
  }
  return term;
}

double VisibilityOf(const MicrofacetModel& model, double n_dot_l, double n_dot_v) {
  switch (model.shadowing) {
    case Shadowing::kHeightCorrelated:
      return VisibilityHeightCorrelated(n_dot_l, n_dot_v, model.alpha);
    case Shadowing::kSeparable:
      return VisibilitySeparable(n_dot_l, n_dot_v, model.alpha);
    case Shadowing::kSchlickDirect:
    case Shadowing::kSchlickIbl:
      break;
  }
  return VisibilitySchlick(n_dot_l, n_dot_v, model.schlick_k);
}

}  // namespace nacre
