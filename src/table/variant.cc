// SPDX-License-Identifier: Apache-2.0
#include "table/variant.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "brdf/angles.h"
#include "brdf/fresnel.h"
#include "brdf/ggx.h"
#include "scene/coat.h"
#include "shading/anisotropic_lobe.h"
#include "shading/derive.h"
#include "shading/scalar_bsdf.h"
#include "shading/share.h"

namespace nacre {
namespace {

const Vec3d kNormal(0, 0, 1);

// Where a formula's slips are in no level's place.
constexpr uint32_t kSpecularSlips = kNoF82Clamp | kAverageForF0 | kFresnelAtNormal |
                                    kFresnelAtView | kFresnelAtLight | kNoShadowing |
                                    kFullyCompensated;
constexpr uint32_t kLayeringSlips =
    kViewForLight | kLightForView | kCoveredBothWays | kNothingCovered;

// Colours Kulla and Conty's lobe by F0, or as white.
void RecolorMultiple(const FormulaSlip slip, MicrofacetModel* model) {
  const AlbedoFit& lobe = model->albedo.lobe;
  const AlbedoAverages albedo{lobe.e_average, lobe.schlick_average, model->albedo.average};
  for (int c = 0; c < 3; ++c) {
    const MicrofacetColors at = ColorsOf(*model, c);
    const CurveAverages curves =
        slip == kF0ForAverage ? CurveAverages{at.dielectric_f0, at.metal_f0} : CurveAverages{1, 1};
    const KullaContyChannel multiple = DeriveKullaConty(*model, at, curves, albedo);
    model->dielectric_f_multiple[c] = multiple.dielectric_f_multiple;
    model->f_multiple[c] = multiple.f_multiple;
  }
}

// The average of Fresnel's mixed curve over its value at normal incidence.
double AverageOverF0(const MicrofacetModel& model, int c) {
  const MicrofacetColors at = ColorsOf(model, c);
  const double metal = at.metallic * at.metal_scale;
  const double dielectric = (1 - at.metallic) * at.dielectric_scale;
  const CurveAverages average =
      model.film ? CurveAverages{model.film->dielectric_average[c], model.film->metal_average[c]}
                 : DeriveAverages(at);
  const double f0 = dielectric * at.dielectric_f0 + metal * at.metal_f0;
  return f0 > 0 ? (dielectric * average.dielectric + metal * average.metal) / f0 : 1;
}

// What is missing to F82's curve without its clamp, of channel c.
double BeyondF82Clamp(const MicrofacetModel& model, double cosine, double one_minus, int c) {
  if (model.fresnel != FresnelForm::kF82 && model.fresnel != FresnelForm::kOpenPbr) return 0;
  const double weight = Power5(one_minus);
  const double value = FresnelSchlick(model.metal_f0[c], 1.0, weight) -
                       model.f82_slope[c] * cosine * one_minus * weight;
  return model.metallic * model.metal_scale * (value - std::clamp(value, 0.0, 1.0));
}

// The specular part of f with mistakes (kSpecularSlips), otherwise as scalar_bsdf.cc has it.
Rgb SpecularOf(const MicrofacetModel& model, const Basis<double>& frame, uint32_t slips,
               const Vec3d& l, const Vec3d& v) {
  const FrameAngles<double> a = ComputeAngles(frame, l, v);
  double cosine = VDotH(a), one_minus = OneMinusVDotH(a);
  if ((slips & kFresnelAtNormal) != 0) {
    cosine = std::clamp(a.n_dot_u / std::sqrt(a.u_squared), 0.0, 1.0);
    one_minus = 1 - cosine;
  }
  if ((slips & kFresnelAtView) != 0) cosine = a.n_dot_v, one_minus = 1 - a.n_dot_v;
  if ((slips & kFresnelAtLight) != 0) cosine = a.n_dot_l, one_minus = 1 - a.n_dot_l;
  const Rgb fresnel = FresnelOf(model, cosine, one_minus);
  const Rgb turquin = TurquinTerm(model, cosine, one_minus);
  GgxTerms terms = GgxTermsOf(model, frame, l, v);
  if ((slips & kNoShadowing) != 0) terms.visibility = 1 / (4 * a.n_dot_l * a.n_dot_v);
  const double lobe = terms.distribution * terms.visibility;
  const double loss_v = LossOf(model, CosinesTo(frame, v));
  const double loss_l = LossOf(model, CosinesTo(frame, l));
  Rgb specular;
  for (int c = 0; c < 3; ++c) {
    double single = fresnel[c];
    if ((slips & kNoF82Clamp) != 0) single += BeyondF82Clamp(model, cosine, one_minus, c);
    specular[c] = single * lobe;
    if (model.compensation == Compensation::kTurquin) {
      double term = turquin[c];
      if ((slips & kAverageForF0) != 0) term *= AverageOverF0(model, c);
      if ((slips & kFullyCompensated) != 0) term = single;
      specular[c] += term * lobe * loss_v / (1 - loss_v);
    } else if (model.compensation == Compensation::kKullaConty) {
      specular[c] += model.f_multiple[c] * model.multiple * loss_v * loss_l;
    }
  }
  return specular;
}

double Ratio(double a, double b) { return b > 0 ? a / b : 1; }

// What slips in layering make of the base's share of light.
Rgb BaseFactor(const MicrofacetModel& model, uint32_t slips, const LobeCosines& to_light,
               const LobeCosines& to_view) {
  if (model.coupling != DiffuseCoupling::kAlbedoScaled) return Rgb(1);
  return MakeRgb([&](int c) {
    const double view = 1 - CoverAlbedo(model, to_view, c);
    const double light = 1 - CoverAlbedo(model, to_light, c);
    const double right = model.reciprocal ? view * light : view;
    if ((slips & kNothingCovered) != 0) return Ratio(1, right);
    if ((slips & kCoveredBothWays) != 0) return model.reciprocal ? 1 : light;
    if ((slips & kLightForView) != 0) return Ratio(light, view);
    if ((slips & kViewForLight) != 0 && model.reciprocal) return Ratio(view, light);
    return 1.0;
  });
}

// The factor of a level on what lies below it, with slips in layering.
Rgb BelowOf(const ShadingMaterial& material, const StackLevel& level, uint32_t slips,
            const Vec3d& l, const Vec3d& v) {
  if ((slips & kNothingCovered) != 0) return Rgb(1);
  if ((slips & (kViewForLight | kLightForView)) == 0) return level.below;
  // The directions that are taken for those of light and view.
  const Vec3d& light = (slips & kViewForLight) != 0 ? v : l;
  const Vec3d& view = (slips & kLightForView) != 0 ? l : v;
  if (level.name == "coat") {
    const ShadingMaterial& coat = *material.coats[level.index];
    return TransmittedByCoat(coat, CosinesTo(FrameOfCoat(material, kNormal, level.index), view),
                             light.z);
  }
  const LayerAngles angles = LayerAnglesOf(kNormal, light, view);
  return Rgb(EvaluateLayer(material.layers[level.index], angles).below);
}

Vec3d YUp(const Vec3d& v) { return {v.x, v.z, v.y}; }
Vec3d TangentTurned(const Vec3d& v) { return {v.y, v.x, v.z}; }

void Redirect(DirectionSlip slip, Vec3d* l, Vec3d* v) {
  switch (slip) {
    case DirectionSlip::kNone:
      break;
    case DirectionSlip::kSwapped:
      std::swap(*l, *v);
      break;
    case DirectionSlip::kYUp:
      *l = YUp(*l);
      *v = YUp(*v);
      break;
    case DirectionSlip::kTangentTurned:
      *l = TangentTurned(*l);
      *v = TangentTurned(*v);
      break;
    case DirectionSlip::kLightReversed:
      *l = -*l;
      break;
    case DirectionSlip::kViewReversed:
      *v = -*v;
      break;
    case DirectionSlip::kBothReversed:
      *l = -*l;
      *v = -*v;
      break;
  }
}

std::vector<std::string> NamesOfLobes(const ShadingMaterial& material) {
  std::vector<std::string> names = {"diffuse", "specular"};
  const auto add = [&](std::string_view name) {
    std::string whole(name);
    for (int k = 2; std::find(names.begin(), names.end(), whole) != names.end(); ++k) {
      whole = fmt::format("{}{}", name, k);
    }
    names.push_back(whole);
  };
  for (const LayerModel& layer : material.layers) {
    if (!LiesOverCoats(layer)) add(NameOf(layer));
  }
  for (size_t k = 0; k < material.coats.size(); ++k) add("coat");
  for (const LayerModel& layer : material.layers) {
    if (LiesOverCoats(layer)) add(NameOf(layer));
  }
  return names;
}

}  // namespace

PreparedVariant::PreparedVariant(const Variant& variant)
    : material_(PrepareWithoutMaps(variant.material)),
      formula_(variant.formula),
      directions_(variant.directions),
      factor_(variant.factor),
      cosines_of_light_(variant.cosines_of_light),
      cosines_of_view_(variant.cosines_of_view) {
  if (auto* const model = std::get_if<MicrofacetModel>(&material_.model)) {
    if (model->compensation == Compensation::kKullaConty) {
      if ((formula_ & kF0ForAverage) != 0) RecolorMultiple(kF0ForAverage, model);
      if ((formula_ & kFullyCompensated) != 0) RecolorMultiple(kFullyCompensated, model);
    }
  }
  is_anisotropic_ = HasAnisotropicLobe(material_);
  lobes_ = NamesOfLobes(material_);
  factors_.assign(lobes_.size(), 1);
  for (const auto& [name, factor] : variant.lobe_factors) {
    const auto at = std::find(lobes_.begin(), lobes_.end(), name);
    if (at != lobes_.end()) factors_[static_cast<size_t>(at - lobes_.begin())] *= factor;
  }
}

void PreparedVariant::Evaluate(const Vec3d& to_light, const Vec3d& to_view,
                               std::span<Rgb> values) const {
  std::fill(values.begin(), values.end(), Rgb(0));
  Vec3d l = to_light, v = to_view;
  Redirect(directions_, &l, &v);
  if (!(l.z > 0) || !(v.z > 0)) return;
  // The levels from the bottom up: that of the model has the first two lobes.
  const std::vector<StackLevel> levels = ReflectByLevel(material_, kNormal, l, v);
  const auto* const microfacet = std::get_if<MicrofacetModel>(&material_.model);
  const Basis<double> frame = FrameOfModel(material_, kNormal);
  for (size_t k = 0; k < levels.size(); ++k) {
    const StackLevel& level = levels[k];
    if (k == 0) {
      values[0] = level.own.diffuse / l.z;
      values[1] = level.own.specular / l.z;
      if (microfacet != nullptr && (formula_ & kSpecularSlips) != 0) {
        values[1] = SpecularOf(*microfacet, frame, formula_, l, v);
      }
      if (microfacet != nullptr && (formula_ & kLayeringSlips) != 0) {
        values[0] *= BaseFactor(*microfacet, formula_, CosinesTo(frame, l), CosinesTo(frame, v));
      }
      continue;
    }
    const Rgb below =
        (formula_ & kLayeringSlips) != 0 ? BelowOf(material_, level, formula_, l, v) : level.below;
    for (size_t i = 0; i <= k; ++i) values[i] *= below;
    values[k + 1] = level.own.Sum() / l.z;
  }
  const double cosines =
      std::pow(l.z, cosines_of_light_) * std::pow(v.z, cosines_of_view_) * factor_;
  for (size_t i = 0; i < values.size(); ++i) values[i] *= factors_[i] * cosines;
}

Rgb PreparedVariant::Evaluate(const Vec3d& to_light, const Vec3d& to_view) const {
  std::array<Rgb, 2 + kMostCoats + kMostLayers> room;
  const std::span<Rgb> values(room.data(), lobes_.size());
  Evaluate(to_light, to_view, values);
  Rgb sum(0, 0, 0);
  for (const Rgb& value : values) sum += value;
  return sum;
}

ViewAlbedos::Key ViewAlbedos::KeyOf(const Vec3d& to_view) const {
  return {std::min(to_view.z, 1.0), of_.is_anisotropic() ? std::atan2(to_view.y, to_view.x) : 0.0};
}

const Rgb& ViewAlbedos::At(const Vec3d& to_view) {
  const Key key = KeyOf(to_view);
  const auto [at, is_new] = known_.try_emplace(key, 0.0, 0.0, 0.0);
  if (is_new) {
    at->second = ReflectedShare(of_.material(), ShareOf::kFurnace, key.first, key.second);
  }
  return at->second;
}

}  // namespace nacre
