// SPDX-License-Identifier: Apache-2.0
#include "shading/material_fit.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "base/error.h"
#include "brdf/fresnel.h"
#include "brdf/quadrature.h"
#include "scene/coat.h"
#include "scene/limits.h"
#include "scene/material_parameters.h"
#include "shading/golden.h"
#include "shading/lobe_fit.h"
#include "shading/log_fit.h"

namespace nacre {
namespace {

constexpr std::array<std::string_view, 6> kTargets = {
    "phong", "modified_phong", "blinn_phong", "metallic_roughness", "dielectric", "open_pbr"};

// Perfect mirrors have no lobe to fit. This roughness corresponds to the largest exponent.
constexpr double kLeastRoughness = 0.007;

// A change of the base's albedo by more than this is reported. It is one 8-bit code of middle grey.
constexpr double kToldAlbedo = 0.005;

constexpr const char* kColoredLobe = "the lobe is coloured; a dielectric's is grey";

Rgb ClampUnit(const Rgb& rgb) {
  return MakeRgb([&](int c) { return std::clamp(rgb[c], 0.0, 1.0); });
}

double Mean(const Rgb& rgb) { return (rgb.x + rgb.y + rgb.z) / 3; }

// The input of the closed forms: the reflectance of the lobe at normal incidence, the albedo of the
// base, and the reflectance for ambient light by the model's own ambient term.
struct Summary {
  Rgb lobe, base, ambient;
};

Summary Summarize(const Material& material) {
  const ShadingMaterial prepared = PrepareMaterial(material);
  Summary summary{Rgb(0), DiffuseAlbedo(material), prepared.of_ambient};
  if (const auto* microfacet = std::get_if<MicrofacetModel>(&prepared.model)) {
    summary.lobe = microfacet->f0;
  } else if (const auto* phong = std::get_if<PhongMaterial>(&material.model)) {
    summary.lobe = phong->ks;
  }
  return summary;
}

// The fraction of the light that the base of a dielectric of this F0 gets, averaged over all views:
// 1 - the lobe's albedo with Turquin's compensation.
double FittedBaseShare(const AlbedoFit& albedo, double f0) {
  const QuadratureRule& rule = GaussLegendre(8);
  double sum = 0;
  for (size_t i = 0; i < rule.x.size(); ++i) {
    const double one = AlbedoOne(albedo, rule.x[i]);
    const double schlick = AlbedoSchlick(albedo, rule.x[i]);
    const double lobe = (f0 * (one - schlick) + schlick) * (1 + f0 * (1 / one - 1));
    sum += 2 * rule.w[i] * rule.x[i] * (1 - lobe);
  }
  return sum;
}

// The base colour and metallic whose F0 and diffuse albedo are nearest to the wanted ones. `weight`
// is the weight of F0's error.
struct MetallicBase {
  Rgb base_color;
  double metallic = 0;
};

MetallicBase SolveMetallic(const Rgb& f0, double weight, const Rgb& diffuse, double roughness) {
  const AlbedoFit albedo = MakeAlbedoFit(Shadowing::kHeightCorrelated, roughness);
  // `metallic` mixes two surfaces: the metal takes no light from the base of the dielectric.
  const double base_share = FittedBaseShare(albedo, kDielectricF0);
  const auto channel_error = [&](double metallic, double base, int c) {
    const double own_f0 = kDielectricF0 * (1 - metallic) + base * metallic;
    const double own_diffuse = (1 - metallic) * base * base_share;
    return weight * (own_f0 - f0[c]) * (own_f0 - f0[c]) +
           (own_diffuse - diffuse[c]) * (own_diffuse - diffuse[c]);
  };
  const auto best_base = [&](double metallic, int c) {
    return GoldenMinimum([&](double base) { return channel_error(metallic, base, c); }, 0, 1);
  };
  const auto error = [&](double metallic) {
    double sum = 0;
    for (int c = 0; c < 3; ++c) sum += channel_error(metallic, best_base(metallic, c), c);
    return sum;
  };
  MetallicBase best;
  best.metallic = ScannedMinimum(error, 0, 1, 20);
  best.base_color = MakeRgb([&](int c) { return best_base(best.metallic, c); });
  return best;
}

PhongModel PhongModelOf(std::string_view target) {
  return std::get<PhongMaterial>(FindModel(target)->make().model).model;
}

void FitPhong(const Material& original, std::string_view target, MaterialFit* fit) {
  const Summary summary = Summarize(original);
  PhongMaterial phong;
  phong.model = PhongModelOf(target);
  phong.ka = ClampUnit(summary.ambient);
  phong.kd = ClampUnit(summary.base);
  phong.ks = ClampUnit(summary.lobe);
  phong.shininess = ExponentFromAlpha(phong.model, LobeAlpha(original));
  fit->guess.model = phong;
  const FittedLobe lobe = FitPhongLobe(original, phong.model);
  phong.ks = lobe.strength;
  phong.shininess = lobe.width;
  fit->fitted.model = phong;
  if (LargestChannel(phong.ks) >= 1) fit->notes.emplace_back("ks is at its limit, 1");
}

MetallicRoughnessMaterial GuessMetallic(const Summary& summary, double alpha) {
  MetallicRoughnessMaterial guess;
  guess.metallic = Mean(summary.lobe) > Mean(summary.base) ? 1 : 0;
  guess.base_color = ClampUnit(guess.metallic > 0 ? summary.lobe : summary.base);
  guess.roughness = std::sqrt(std::min(alpha, 1.0));
  return guess;
}

// The base colour under which `white`, this material with a white base, reflects `base` diffusely.
Rgb BaseUnder(const Material& white, const Rgb& base) {
  const Rgb share = DiffuseAlbedo(white);
  return ClampUnit(MakeRgb([&](int c) { return share[c] > 0 ? base[c] / share[c] : 0.0; }));
}

bool IsTinted(const Rgb& f0) {
  return std::max({f0.x, f0.y, f0.z}) - std::min({f0.x, f0.y, f0.z}) > 0.005;
}

// Fits a dielectric whose `specular` scales its lobe to the original's, which is weaker than a full
// dielectric's, over a base with the diffuse albedo of the original's.
void FitWeakLobe(const Material& original, const Summary& summary, MaterialFit* fit) {
  MetallicRoughnessMaterial material = std::get<MetallicRoughnessMaterial>(fit->fitted.model);
  material.metallic = 0;
  material.base_color = Rgb(1);
  const auto with = [&](double specular) {
    Material candidate = fit->fitted;
    material.specular = specular;
    candidate.model = material;
    return candidate;
  };
  const auto error = [&](double specular) { return MeasureResidual(original, with(specular)).rms; };
  // If the original has no lobe, only `specular` = 0 has a finite residual.
  const Material white = with(error(0) == 0 ? 0 : GoldenMinimum(error, 0, 1));
  material = std::get<MetallicRoughnessMaterial>(white.model);
  material.base_color = BaseUnder(white, summary.base);
  fit->fitted.model = material;
}

// Fits the roughness again for a dielectric whose index is at its limit, so that its lobe is as
// near as possible to the original's.
void RefitRoughness(const Material& original, MaterialFit* fit) {
  const double from = std::get<DielectricMaterial>(fit->fitted.model).roughness;
  const auto with = [&](double log_roughness) {
    Material material = fit->fitted;
    std::get<DielectricMaterial>(material.model).roughness = std::min(std::exp(log_roughness), 1.0);
    return material;
  };
  const auto error = [&](double log) { return MeasureResidual(original, with(log)).rms; };
  fit->fitted =
      with(ScannedMinimum(error, std::log(from / 2), std::log(std::min(2 * from, 1.0)), 12));
}

double IndexFromF0(double f0) {
  const double root = std::sqrt(std::clamp(f0, 0.0, 0.999));
  return std::clamp((1 + root) / (1 - root), limits::kIor.min, limits::kIor.max);
}

// Plastics have indices from 1.3 (fluoropolymers) to 1.75 (optical resins).
constexpr double kLeastPlasticIor = 1.3;
constexpr double kMostPlasticIor = 1.75;

// A Phong lobe may have any strength. Notes a strength that no plastic has.
void NoteStrength(double f0, MaterialFit* fit) {
  const double ior = IndexFromF0(f0);
  if (ior >= kLeastPlasticIor && ior <= kMostPlasticIor) return;
  const double least = FresnelF0(kLeastPlasticIor, 0.0);
  const double most = FresnelF0(kMostPlasticIor, 0.0);
  fit->notes.push_back(fmt::format(
      "plastics reflect {:.2g} to {:.2g} of the light at normal view (indices of {} to {}); this "
      "lobe reflects {:.2g}, as an index of {:.3g} does{}",
      least, most, kLeastPlasticIor, kMostPlasticIor, f0, ior,
      f0 > most ? ": ks is that of a gem or a metal" : ""));
}

void FitMetallic(const Material& original, MaterialFit* fit) {
  if (std::holds_alternative<MetallicRoughnessMaterial>(original.model)) {
    fit->guess.model = fit->fitted.model = original.model;
    return;
  }
  const Summary summary = Summarize(original);
  MetallicRoughnessMaterial material = GuessMetallic(summary, LobeAlpha(original));
  fit->guess.model = material;
  const FittedLobe free = FitGgxLobe(original);
  // The colour of a lobe that is about as weak as a dielectric's, such as a film's, is not that of
  // a metal, which would take a brighter base away.
  const bool is_dielectric = LargestChannel(free.strength) < 2 * kDielectricF0 &&
                             Mean(summary.base) > LargestChannel(free.strength);
  const Rgb strength = is_dielectric ? Rgb(Mean(free.strength)) : free.strength;
  const bool is_weak = LargestChannel(strength) < kDielectricF0;
  if ((is_dielectric || is_weak) && IsTinted(free.strength)) fit->notes.emplace_back(kColoredLobe);
  material.roughness = std::sqrt(free.width);
  if (is_weak) {
    fit->fitted.model = material;
    FitWeakLobe(original, summary, fit);
    return;
  }
  const double guess_rms = MeasureResidual(original, fit->guess).rms;
  MetallicBase base;
  // One colour determines both lobe and base. The fit keeps as much of the base's colour as leaves
  // the lobe's residual no larger than that of the guess.
  for (double weight = 1; weight < 1e6; weight *= 2) {
    base = SolveMetallic(strength, weight, summary.base, material.roughness);
    material.base_color = base.base_color;
    material.metallic = base.metallic;
    fit->fitted.model = material;
    if (MeasureResidual(original, fit->fitted).rms <= guess_rms) break;
  }
  const Rgb f0 = Rgb(kDielectricF0) * (1 - base.metallic) + base.base_color * base.metallic;
  if (base.metallic > 0 && base.metallic < 1) NoteStrength(Mean(strength), fit);
  const Rgb gap = strength - f0;
  const double worst = std::max({std::abs(gap.x), std::abs(gap.y), std::abs(gap.z)});
  if (worst > 0.005) {
    fit->notes.push_back(fmt::format(
        "the lobe asks for F0 {:.3f} {:.3f} {:.3f}, one base colour for both lobe and base allows "
        "{:.3f} {:.3f} {:.3f}{}",
        free.strength.x, free.strength.y, free.strength.z, f0.x, f0.y, f0.z,
        base.metallic < 0.5 ? "; its dielectric_f0 says it apart, and so does --to dielectric"
                            : ""));
  }
}

void FitDielectric(const Material& original, MaterialFit* fit) {
  const Summary summary = Summarize(original);
  DielectricMaterial material;
  material.ior = IndexFromF0(Mean(summary.lobe));
  material.base_color = ClampUnit(summary.base);
  material.roughness = std::sqrt(std::min(LobeAlpha(original), 1.0));
  fit->guess.model = material;
  const FittedLobe lobe = FitGgxLobe(original);
  material.ior = IndexFromF0(Mean(lobe.strength));
  material.roughness = std::sqrt(lobe.width);
  material.base_color = Rgb(1);
  fit->fitted.model = material;
  if (material.ior == limits::kIor.max) {
    RefitRoughness(original, fit);
    fit->notes.push_back(fmt::format("its index of refraction is at its limit, {}", material.ior));
  }
  material = std::get<DielectricMaterial>(fit->fitted.model);
  material.base_color = BaseUnder(fit->fitted, summary.base);
  fit->fitted.model = material;
  if (IsTinted(lobe.strength)) fit->notes.emplace_back(kColoredLobe);
  NoteStrength(Mean(lobe.strength), fit);
}

// The material without its model and without maps.
Material WithoutModel(Material material) {
  const Rgb emission = EmissionOf(material);
  for (int c = 0; c < 3; ++c) {
    material.emission[c] = std::min(emission[c], limits::kRadiance.max);
  }
  material.model = {};
  material.user = nullptr;
  material.emission_map = material.opacity_map = {};
  material.normal_map = {};
  material.bump_map = {};
  return material;
}

// Notes what no fit between these models can preserve.
void NoteLosses(const Material& original, bool to_phong, MaterialFit* fit) {
  if (const auto* measured = std::get_if<MeasuredMaterial>(&original.model)) {
    if (measured->brdf && !measured->brdf->isotropic) {
      fit->notes.emplace_back("anisotropy: fitted as it looks from along the tangent");
    }
    return;
  }
  const bool from_phong = std::holds_alternative<PhongMaterial>(original.model);
  if (to_phong && !from_phong) {
    fit->notes.emplace_back(
        "Fresnel: the lobe's strength is the same from everywhere, where the original's grows "
        "towards grazing angles");
    fit->notes.emplace_back("GGX's long tail: an exponential lobe ends sooner");
  }
  if (from_phong && !to_phong) {
    fit->notes.emplace_back("the lobe grows towards grazing angles and has a longer tail");
    fit->notes.emplace_back("ka: ambient light reflects as much as the model's own colours say");
  }
  const MaterialModel* const model = ModelOf(original);
  const bool has_maps =
      original.emission_map.valid() || original.normal_map.texture.valid() ||
      original.bump_map.texture.valid() ||
      std::any_of(model->maps.begin(), model->maps.end(),
                  [&](const MaterialMap& map) { return map.get(original).valid(); });
  if (has_maps) fit->notes.emplace_back("maps are not converted");
}

// The original without the layers over it, which other models do not have.
Material WithoutLayers(Material material, std::vector<std::string>* notes) {
  if (RemoveCoats(&material)) notes->emplace_back("the coat: what is below it is converted");
  for (const std::string_view layer : RemoveLayers(&material)) {
    notes->push_back(fmt::format("{}: what is below it is converted", layer));
  }
  return material;
}

// The original, with a lobe that is as wide in all directions.
Material WithoutAnisotropy(Material material, std::vector<std::string>* notes) {
  const auto flatten = [&](double* anisotropy) {
    if (*anisotropy == 0) return;
    *anisotropy = 0;
    notes->emplace_back("anisotropy: fitted as if there were none");
  };
  if (auto* m = std::get_if<MetallicRoughnessMaterial>(&material.model)) flatten(&m->anisotropy);
  if (auto* m = std::get_if<OpenPbrMaterial>(&material.model)) {
    flatten(&m->specular_roughness_anisotropy);
  }
  return material;
}

// The original, with a lobe that is wide enough to be fitted.
Material WithLobe(Material material, std::vector<std::string>* notes) {
  const auto raise = [&](double* roughness) {
    if (*roughness >= kLeastRoughness) return;
    *roughness = kLeastRoughness;
    notes->push_back(
        fmt::format("fitted as if its roughness were {}: mirrors have no lobe", kLeastRoughness));
  };
  if (auto* m = std::get_if<MetallicRoughnessMaterial>(&material.model)) raise(&m->roughness);
  if (auto* m = std::get_if<ConductorMaterial>(&material.model)) raise(&m->roughness);
  if (auto* m = std::get_if<DielectricMaterial>(&material.model)) raise(&m->roughness);
  if (auto* m = std::get_if<OpenPbrMaterial>(&material.model)) raise(&m->specular_roughness);
  return material;
}

}  // namespace

std::span<const std::string_view> FitTargets() { return kTargets; }

MaterialFit FitMaterial(const Material& original, std::string_view target) {
  if (ModelOf(original) == nullptr) {
    throw Error(ExitCode::kBadInput, original.name, "a split is not one material",
                "convert those that it is made of");
  }
  MaterialFit fit;
  const bool keeps_layers = target == "metallic_roughness" &&
                            std::holds_alternative<MetallicRoughnessMaterial>(original.model);
  const auto bare = [&] {
    return WithoutAnisotropy(WithoutLayers(original, &fit.notes), &fit.notes);
  };
  const Material material = WithoutMaps(WithLobe(keeps_layers ? original : bare(), &fit.notes));
  fit.guess = fit.fitted = WithoutModel(original);
  const bool to_phong = target.ends_with("phong");
  const bool measured = std::holds_alternative<MeasuredMaterial>(original.model);
  if (measured || target == "open_pbr") {
    const LogFit of_values = FitLog(material, target, fit.guess);
    fit.guess = of_values.guess;
    fit.fitted = of_values.fitted;
    fit.guess_log_rms = LogResidual(material, fit.guess);
    fit.log_rms = LogResidual(material, fit.fitted);
  } else if (to_phong) {
    FitPhong(material, target, &fit);
  } else if (target == "dielectric") {
    FitDielectric(material, &fit);
  } else {
    FitMetallic(material, &fit);
  }
  fit.guess_residual = MeasureResidual(material, fit.guess);
  fit.residual = MeasureResidual(material, fit.fitted);
  const Rgb base = DiffuseAlbedo(material);
  const Rgb fitted_base = DiffuseAlbedo(fit.fitted);
  if (!measured &&
      LargestChannel((fitted_base - base) * (fitted_base - base)) > kToldAlbedo * kToldAlbedo) {
    fit.notes.push_back(
        fmt::format("the base's albedo: {:.3f} {:.3f} {:.3f} of light from everywhere becomes "
                    "{:.3f} {:.3f} {:.3f}",
                    base.x, base.y, base.z, fitted_base.x, fitted_base.y, fitted_base.z));
  }
  NoteLosses(original, to_phong, &fit);
  return fit;
}

}  // namespace nacre
