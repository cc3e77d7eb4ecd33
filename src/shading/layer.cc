// SPDX-License-Identifier: Apache-2.0
#include "shading/layer.h"

#include <algorithm>
#include <limits>

#include "scene/material.h"
#include "shading/hit_parameters.h"

namespace nacre {
namespace {

LayerReflection TermsOf(const SheenModel& sheen, const LayerAngles& a) {
  const double albedo_v = CharlieAlbedo(sheen.charlie, a.n_dot_v);
  const double albedo_l = sheen.scaling == SheenScaling::kReciprocal
                              ? CharlieAlbedo(sheen.charlie, a.n_dot_l)
                              : albedo_v;
  const SheenScale<double> scale = ScaleSheen(LargestChannel(sheen.color), albedo_v, albedo_l);
  const double lobe = CharlieLobe(sheen.charlie, a) * a.n_dot_l * scale.lobe;
  return {sheen.color * lobe, scale.below};
}

LayerReflection AlbedoOf(const SheenModel& sheen, double n_dot_v) {
  const double albedo = CharlieAlbedo(sheen.charlie, n_dot_v);
  const SheenScale<double> scale = ScaleSheen(LargestChannel(sheen.color), albedo, albedo);
  return {sheen.color * (albedo * scale.lobe), scale.below};
}

Vec3d SampleOf(const SheenModel& sheen, const Vec3d& normal, const Vec3d&, double u0, double u1) {
  return SampleCharlie(normal, sheen.charlie.roughness, u0, u1);
}

double PdfOf(const SheenModel& sheen, const LayerAngles& a) {
  return CharliePdf(a.n_dot_l, sheen.charlie.roughness);
}

SheenModel ModelAtHit(const SheenModel& sheen, const HitParameters& textures, size_t i) {
  return {ColorOfHit(textures, MappedNumber::kSheenColor, i),
          MakeCharlie(NumbersOf(textures, MappedNumber::kSheenRoughness)[i]), sheen.scaling};
}

LayerReflection TermsOf(const FuzzModel& fuzz, const LayerAngles& a) {
  const FuzzView<double> view = FuzzFromView(fuzz.fuzz, a.n_dot_v);
  return {fuzz.color * (fuzz.weight * FuzzLobe(view, a) * a.n_dot_l),
          1 - fuzz.weight * view.albedo};
}

LayerReflection AlbedoOf(const FuzzModel& fuzz, double n_dot_v) {
  const double albedo = fuzz.weight * FuzzAlbedo(fuzz.fuzz, n_dot_v);
  return {fuzz.color * albedo, 1 - albedo};
}

Vec3d SampleOf(const FuzzModel& fuzz, const Vec3d& normal, const Vec3d& to_view, double u0,
               double u1) {
  return SampleFuzz(normal, to_view, FuzzFromView(fuzz.fuzz, normal ^ to_view), u0, u1);
}

double PdfOf(const FuzzModel& fuzz, const LayerAngles& a) {
  return FuzzPdf(FuzzFromView(fuzz.fuzz, a.n_dot_v), a);
}

FuzzModel ModelAtHit(const FuzzModel& fuzz, const HitParameters& textures, size_t i) {
  return {fuzz.weight, ColorOfHit(textures, MappedNumber::kSheenColor, i),
          MakeFuzz(NumbersOf(textures, MappedNumber::kSheenRoughness)[i])};
}

std::vector<std::pair<std::string_view, double>> NamedTermsOf(const FuzzModel& fuzz,
                                                              const LayerAngles& a) {
  const FuzzView<double> view = FuzzFromView(fuzz.fuzz, a.n_dot_v);
  return {{"roughness", fuzz.fuzz.roughness},
          {"R", view.albedo},
          {"D", FuzzPdf(view, a)},
          {"weight", fuzz.weight}};
}

double WidthOf(const FuzzModel&) { return std::numeric_limits<double>::infinity(); }

std::vector<std::pair<std::string_view, double>> NamedTermsOf(const SheenModel& sheen,
                                                              const LayerAngles& a) {
  const Charlie<double>& charlie = sheen.charlie;
  return {{"roughness", charlie.roughness},
          {"D", CharlieDistribution(a, charlie.alpha)},
          {"V", CharlieVisibility(a.n_dot_l, a.n_dot_v, CharlieCosineLambda(charlie, a.n_dot_l),
                                  CharlieCosineLambda(charlie, a.n_dot_v))},
          {"albedo_l", CharlieAlbedo(charlie, a.n_dot_l)},
          {"albedo_v", CharlieAlbedo(charlie, a.n_dot_v)}};
}

double WidthOf(const SheenModel&) { return std::numeric_limits<double>::infinity(); }

bool ShowsSheen(const MetallicRoughnessMaterial& material) {
  return !IsBlack(material.sheen_color) &&
         !IsDeltaLobe(AlphaFromRoughness(material.sheen_roughness));
}

}  // namespace

std::vector<LayerModel> MakeLayers(const Material& material) {
  std::vector<LayerModel> layers;
  const auto* const model = std::get_if<MetallicRoughnessMaterial>(&material.model);
  if (model != nullptr && ShowsSheen(*model)) {
    layers.emplace_back(
        SheenModel{model->sheen_color, MakeCharlie(model->sheen_roughness), model->sheen_scaling});
  }
  const auto* const open_pbr = std::get_if<OpenPbrMaterial>(&material.model);
  if (open_pbr != nullptr && open_pbr->fuzz_weight > 0) {
    layers.emplace_back(
        FuzzModel{open_pbr->fuzz_weight, open_pbr->fuzz_color, MakeFuzz(open_pbr->fuzz_roughness)});
  }
  return layers;
}

std::vector<std::string_view> RemoveLayers(Material* material) {
  std::vector<std::string_view> names;
  for (const LayerModel& layer : MakeLayers(*material)) names.push_back(NameOf(layer));
  if (auto* model = std::get_if<MetallicRoughnessMaterial>(&material->model)) {
    model->sheen_color = Rgb(0, 0, 0);
  }
  if (auto* model = std::get_if<OpenPbrMaterial>(&material->model)) model->fuzz_weight = 0;
  return names;
}

LayerReflection EvaluateLayer(const LayerModel& layer, const LayerAngles& angles) {
  return std::visit([&](const auto& model) { return TermsOf(model, angles); }, layer);
}

LayerReflection LayerAlbedo(const LayerModel& layer, double n_dot_v) {
  return std::visit([&](const auto& model) { return AlbedoOf(model, n_dot_v); }, layer);
}

LayerModel LayerAtHit(const LayerModel& layer, const HitParameters* maps, size_t i) {
  if (maps == nullptr) return layer;
  return std::visit([&](const auto& model) -> LayerModel { return ModelAtHit(model, *maps, i); },
                    layer);
}

std::vector<std::pair<std::string_view, double>> LayerTerms(const LayerModel& layer,
                                                            const LayerAngles& angles) {
  return std::visit([&](const auto& model) { return NamedTermsOf(model, angles); }, layer);
}

double LayerLobeWidth(const LayerModel& layer) {
  return std::visit([](const auto& model) { return WidthOf(model); }, layer);
}

Vec3d SampleLayer(const LayerModel& layer, const Vec3d& normal, const Vec3d& to_view, double u0,
                  double u1) {
  return std::visit([&](const auto& model) { return SampleOf(model, normal, to_view, u0, u1); },
                    layer);
}

double LayerPdf(const LayerModel& layer, const LayerAngles& angles) {
  return std::visit([&](const auto& model) { return PdfOf(model, angles); }, layer);
}

}  // namespace nacre
