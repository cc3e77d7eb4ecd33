// SPDX-License-Identifier: Apache-2.0
#include "shading/lobe_chances.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include "brdf/fresnel.h"
#include "brdf/measured.h"
#include "shading/lobe_sample.h"
#include "shading/models_at_hit.h"

namespace nacre {
namespace {

// The numbers of a microfacet model that the estimates need, in the brightest channel.
struct GgxNumbers {
  double diffuse, f0, f90;
  bool delta;
  double f_multiple, loss;  // kKullaConty; else 0
};

// Schlick's curve through F0 and F90 stands for all Fresnel curves.
ModelAlbedos AlbedosOfGgx(const GgxNumbers& n, double n_dot_v) {
  const double fresnel = n.f0 + (n.f90 - n.f0) * Power5(1 - n_dot_v);
  ModelAlbedos albedos;
  albedos.diffuse = n.diffuse;
  (n.delta ? albedos.mirror : albedos.glossy) = fresnel * (1 - n.loss);
  albedos.glossy += n.f_multiple * n.loss;
  return albedos;
}

// A film may reflect nothing along the normal of what it reflects elsewhere, so that its means over
// the hemisphere stand for its curves.
double LargestUnderFilm(const ThinFilmLobe& film, double dielectric, double metal) {
  return LargestChannel(film.dielectric_average * dielectric + film.metal_average * metal);
}

bool HasSecondLobe(const MicrofacetModel& model) {
  return model.compensation == Compensation::kKullaConty;
}

ModelAlbedos AlbedosOfModel(const std::monostate&, const LobeCosines&) { return {}; }

ModelAlbedos AlbedosOfModel(const MatteModel& matte, const LobeCosines&) {
  return {.diffuse = LargestChannel(matte.diffuse) * M_PI};
}

ModelAlbedos AlbedosOfModel(const PhongFamilyModel& phong, const LobeCosines&) {
  return {.diffuse = LargestChannel(phong.diffuse) * M_PI,
          .glossy = LargestChannel(phong.specular) * 2 * M_PI / (phong.shininess + 2)};
}

// Nothing is known of a user model: it has one lobe.
ModelAlbedos AlbedosOfModel(const UserModel& user, const LobeCosines&) {
  return user.brdf->sample ? ModelAlbedos{.glossy = 1} : ModelAlbedos{.diffuse = 1};
}

ModelAlbedos AlbedosOfModel(const MeasuredModel& measured, const LobeCosines& v) {
  return {.glossy = LargestChannel(MeasuredAlbedo(*measured.brdf, v.n))};
}

ModelAlbedos AlbedosOfModel(const MicrofacetModel& model, const LobeCosines& v) {
  const bool second = HasSecondLobe(model) && model.multiple > 0;
  double f0 = LargestChannel(model.f0);
  if (model.film) {
    f0 =
        LargestUnderFilm(*model.film, (1 - model.metallic) * LargestChannel(model.dielectric_scale),
                         model.metallic * model.metal_scale);
  }
  return AlbedosOfGgx(
      {LargestChannel(model.diffuse) * M_PI, f0, model.f90, model.delta,
       second ? LargestChannel(model.f_multiple) : 0, second ? LossOf(model, v) : 0},
      v.n);
}

double NumberOfHit(float number, size_t) { return double{number}; }
double NumberOfHit(const float* numbers, size_t i) { return double{numbers[i]}; }

template <class Number>
ModelAlbedos AlbedosAtHit(const MicrofacetModel& model,
                          const MicrofacetConstants<Number>& constants, const Rgb& diffuse,
                          const Surface& surface, size_t i, double n_dot_v) {
  const auto largest = [i](const Number(&rgb)[3]) {
    return std::max({NumberOfHit(rgb[0], i), NumberOfHit(rgb[1], i), NumberOfHit(rgb[2], i)});
  };
  GgxNumbers numbers{LargestChannel(diffuse) * M_PI,
                     largest(constants.f0),
                     NumberOfHit(constants.f90, i),
                     NumberOfHit(constants.not_delta, i) == 0,
                     0,
                     0};
  if (model.film) {
    const double metal = NumberOfHit(constants.metal, i);
    const bool by_hit = model.film->metal_by_hit;
    numbers.f0 = LargestUnderFilm(*model.film, largest(constants.dielectric), by_hit ? 0 : metal);
    if (by_hit) numbers.f0 += metal * largest(constants.metal_f0);
  }
  const double multiple = NumberOfHit(constants.multiple, i);
  if (HasSecondLobe(model) && multiple > 0) {
    numbers.f_multiple = largest(constants.f_multiple);
    numbers.loss = std::min(double{surface.multiple[i]} / multiple, 1.0);
  }
  return AlbedosOfGgx(numbers, n_dot_v);
}

}  // namespace

ModelAlbedos AlbedosOf(const ShadingMaterial& material, const LobeCosines& v) {
  return std::visit([&](const auto& model) { return AlbedosOfModel(model, v); }, material.model);
}

ModelAlbedos AlbedosAt(const ShadingMaterial& material, const HitParameters* maps,
                       const Surface& surface, size_t i, double n_dot_v) {
  const auto* model = std::get_if<MicrofacetModel>(&material.model);
  if (model == nullptr) {
    ModelAlbedos albedos = AlbedosOf(material, n_dot_v);
    if (std::holds_alternative<MeasuredModel>(material.model)) return albedos;  // has no maps
    if (maps != nullptr) albedos.diffuse = LargestChannel(Rgb(VectorAt(maps->albedo, i)));
    return albedos;
  }
  // By the numbers of kernels in both cases: a constant map then gives the bits of the constant.
  if (maps == nullptr) {
    return AlbedosAtHit(*model, model->constants, model->diffuse, surface, i, n_dot_v);
  }
  Rgb diffuse;
  for (int c = 0; c < 3; ++c) {
    VisitChannel(material, *maps, c,
                 [&](const auto& channel) { diffuse[c] = channel.Colors(i).diffuse; });
  }
  return AlbedosAtHit(*model, ColumnsIn<MicrofacetConstants<float*>>(maps->constants), diffuse,
                      surface, i, n_dot_v);
}

double BaseAlbedo(const ShadingMaterial& material, const HitParameters* maps, size_t i) {
  const Rgb color(maps != nullptr ? Vec3f(VectorAt(maps->albedo, i)) : Vec3f(material.albedo));
  const auto* const model = std::get_if<MicrofacetModel>(&material.model);
  if (model == nullptr) return LargestChannel(color);
  const double metallic =
      maps != nullptr ? NumbersOf(*maps, MappedNumber::kMetallic)[i] : model->metallic;
  return LargestChannel(color) * (1 - metallic);
}

LayerChance ChanceOf(const LayerModel& layer, double n_dot_v, double below_albedo) {
  const LayerReflection albedo = LayerAlbedo(layer, n_dot_v);
  const double own = LargestChannel(albedo.lobe), below = albedo.below * below_albedo;
  return {Fraction(own, below), own + below};
}

void FindCoatChances(std::span<const CoatInView> coats, double glossy, std::span<double> chances) {
  for (size_t k = 0; k < coats.size(); ++k) {
    const double albedo = coats[k].is_mirror ? 0 : LargestChannel(coats[k].albedo);
    glossy *= LargestChannel(coats[k].transmittance);
    chances[k] = std::clamp(Fraction(albedo, glossy), 0.0, 1.0);
    glossy += albedo;
  }
}

KindChances ChancesOfKinds(const std::vector<LayerModel>& layers, double n_dot_v,
                           const ModelAlbedos& albedos, std::span<const CoatInView> coats,
                           bool mirrors) {
  // From the top down: `left` is what the levels so far let through.
  double left = 1;
  KindChances chances{.diffuse = 0};
  const auto take_layers = [&](bool over_coats) {
    for (size_t k = layers.size(); k-- > 0;) {
      if (LiesOverCoats(layers[k]) != over_coats) continue;
      const LayerReflection albedo = LayerAlbedo(layers[k], n_dot_v);
      (KindOf(layers[k]) == LobeKind::kDiffuse ? chances.diffuse : chances.glossy) +=
          left * LargestChannel(albedo.lobe);
      left *= albedo.below;
    }
  };
  take_layers(true);
  for (size_t k = coats.size(); k-- > 0;) {
    const double reflected = left * LargestChannel(coats[k].albedo);
    if (!coats[k].is_mirror) {
      chances.glossy += reflected;
    } else if (mirrors) {
      chances.mirror[1 + k] = reflected;
    }
    left *= LargestChannel(coats[k].transmittance);
  }
  take_layers(false);
  chances.diffuse += left * albedos.diffuse;
  chances.glossy += left * albedos.glossy;
  if (mirrors) chances.mirror[0] = left * albedos.mirror;
  double sum = chances.diffuse + chances.glossy;
  for (const double mirror : chances.mirror) sum += mirror;
  if (!(sum > 0)) return {};
  chances.diffuse /= sum;
  chances.glossy /= sum;
  for (double& mirror : chances.mirror) mirror /= sum;
  return chances;
}

size_t ChooseKind(const KindChances& chances, Chooser* chooser) {
  double left = 1;  // of the probability, for what has not been refused
  const auto takes = [&](double chance) {
    const bool taken = chance > 0 && chooser->Takes(std::min(chance / left, 1.0));
    left -= chance;
    return taken;
  };
  for (size_t level = chances.mirror.size(); level-- > 0;) {
    if (takes(chances.mirror[level])) return kMirrorChosen + level;
  }
  return takes(chances.glossy) ? kGlossyChosen : kDiffuseChosen;
}

}  // namespace nacre
