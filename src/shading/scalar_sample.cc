// SPDX-License-Identifier: Apache-2.0
#include "shading/scalar_sample.h"

#include <algorithm>
#include <cmath>

#include "base/overloaded.h"
#include "brdf/lobe_sampling.h"
#include "brdf/multi_scatter.h"
#include "shading/scalar_material.h"
#include "shading/user_model.h"

namespace nacre {
namespace {

// The probability of sampling the lobe rather than a cosine-weighted direction: the lobe's fraction
// of what both reflect, approximately.
double LobeShareOf(double lobe, double diffuse) {
  return lobe + diffuse > 0 ? lobe / (lobe + diffuse) : 0;
}

double LobeChance(const PhongFamilyModel& model, double) {
  const double scale = 2 * M_PI / (model.shininess + 2);
  return LobeShareOf(LargestChannel(model.specular) * scale, LargestChannel(model.diffuse) * M_PI);
}

// Cosine-weighted directions also serve for the lobe of Kulla and Conty's compensation, which is
// flatter.
double LobeChance(const MicrofacetModel& model, double n_dot_v) {
  const double single = model.delta ? 0 : LargestChannel(FresnelOf(model, n_dot_v, 1 - n_dot_v));
  double diffuse = LargestChannel(model.diffuse) * M_PI;
  if (model.compensation == Compensation::kKullaConty) {
    diffuse += LargestChannel(model.f_multiple) * AlbedoLoss(model.albedo.lobe, n_dot_v);
  }
  return LobeShareOf(single, diffuse);
}

template <class Model>
double LobeChance(const Model&, double) {
  return 0;
}

// The probability of sampling a coat is its albedo, that of a layer the layer's fraction of its
// albedo plus the light that it leaves for what is below.
double CoatChance(const ShadingMaterial& material, double n_dot_v) {
  const Rgb left = LeftByCoat(*material.coat, n_dot_v);
  const double coat = 1 - std::min({left.x, left.y, left.z});
  return std::clamp(coat, 0.0, 1.0);
}

double LayerChance(const LayerModel& layer, double n_dot_v) {
  const LayerReflection albedo = LayerAlbedo(layer, n_dot_v);
  return LobeShareOf(LargestChannel(albedo.lobe), albedo.below);
}

Vec3d SampleModel(const ShadingMaterial& material, const Vec3d& n, const Vec3d& v, double u0,
                  double u1) {
  if (const auto* user = std::get_if<UserModel>(&material.model)) {
    return SampleUser(*user, n, v, u0, u1);
  }
  const double chance =
      std::visit([&](const auto& m) { return LobeChance(m, n ^ v); }, material.model);
  if (u0 >= chance) return SampleCosine(n, (u0 - chance) / (1 - chance), u1);
  u0 /= chance;
  if (const auto* phong = std::get_if<PhongFamilyModel>(&material.model)) {
    return phong->model == PhongModel::kBlinnPhong
               ? SampleBlinnLobe(n, v, phong->shininess, u0, u1)
               : SamplePhongLobe(n, v, phong->shininess, u0, u1);
  }
  return SampleGgxVisible(n, v, std::get<MicrofacetModel>(material.model).alpha, u0, u1);
}

double ModelPdf(const ShadingMaterial& material, const Vec3d& n, const Vec3d& v, const Vec3d& l) {
  if (const auto* user = std::get_if<UserModel>(&material.model)) return UserPdf(*user, n, v, l);
  const double chance =
      std::visit([&](const auto& m) { return LobeChance(m, n ^ v); }, material.model);
  const double cosine = (1 - chance) * CosinePdf(n ^ l);
  if (chance == 0) return cosine;
  if (const auto* phong = std::get_if<PhongFamilyModel>(&material.model)) {
    return cosine + chance * (phong->model == PhongModel::kBlinnPhong
                                  ? BlinnLobePdf(n, v, l, phong->shininess)
                                  : PhongLobePdf(n, v, l, phong->shininess));
  }
  return cosine + chance * GgxVisiblePdf(n, v, l, std::get<MicrofacetModel>(material.model).alpha);
}

}  // namespace

Vec3d SampleReflection(const ShadingMaterial& material, const Vec3d& normal, const Vec3d& to_view,
                       double u0, double u1) {
  const double n_dot_v = std::clamp(normal ^ to_view, 0.0, 1.0);
  // The number that chooses a component is rescaled to [0, 1), and used again for a direction.
  if (material.coat) {
    const double chance = CoatChance(material, n_dot_v);
    if (u0 < chance) {
      return SampleReflection(*material.coat, normal, to_view, u0 / chance, u1);
    }
    u0 = (u0 - chance) / (1 - chance);
  }
  for (size_t k = material.layers.size(); k-- > 0;) {
    const double chance = LayerChance(material.layers[k], n_dot_v);
    if (u0 < chance) return SampleLayer(material.layers[k], normal, u0 / chance, u1);
    u0 = (u0 - chance) / (1 - chance);
  }
  return SampleModel(material, normal, to_view, u0, u1);
}

double ReflectionPdf(const ShadingMaterial& material, const Vec3d& normal, const Vec3d& to_view,
                     const Vec3d& to_light) {
  const double n_dot_v = std::clamp(normal ^ to_view, 0.0, 1.0);
  double pdf = 0, left = 1;
  if (material.coat) {
    const double chance = CoatChance(material, n_dot_v);
    if (chance > 0) pdf += chance * ReflectionPdf(*material.coat, normal, to_view, to_light);
    left -= chance;
  }
  for (size_t k = material.layers.size(); k-- > 0;) {
    const double chance = LayerChance(material.layers[k], n_dot_v);
    pdf += left * chance * LayerPdf(material.layers[k], normal ^ to_light);
    left *= 1 - chance;
  }
  return left > 0 ? pdf + left * ModelPdf(material, normal, to_view, to_light) : pdf;
}

}  // namespace nacre
