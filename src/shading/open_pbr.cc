// SPDX-License-Identifier: Apache-2.0
#include "shading/open_pbr.h"

#include <algorithm>

#include "brdf/open_pbr.h"

namespace nacre {
namespace {

double Lerp(double a, double b, double t) { return a + (b - a) * t; }

// The weight by which specular_weight changes the index.
double IndexWeight(const OpenPbrMaterial& material) {
  return material.options.specular_weight_rule == SpecularWeightRule::kFactor
             ? 1
             : material.specular_weight;
}

// The roughness below a coat that covers all of the base.
double WhollyCoated(const OpenPbrMaterial& material, double r) {
  const double c = CoatRoughnessOf(material);
  const double n = material.coat_ior;
  switch (material.options.coat_roughening) {
    case CoatRoughening::kSpec:
      return RoughnessBelowCoat(r, c, 2.0);
    case CoatRoughening::kAdobe:
      return RoughnessBelowCoat(r, c, 1 - std::min(n, 1 / n));
    case CoatRoughening::kFit261:
      return FittedRoughnessBelowCoat(r, c, n);
    case CoatRoughening::kNone:
      break;
  }
  return r;
}

}  // namespace

double RoughnessBelowCoat(const OpenPbrMaterial& material) {
  return RoughnessBelowCoat(material, material.specular_roughness);
}

double RoughnessBelowCoat(const OpenPbrMaterial& material, double specular_roughness) {
  if (!(material.coat_weight > 0)) return specular_roughness;
  return Lerp(specular_roughness, WhollyCoated(material, specular_roughness), material.coat_weight);
}

namespace {

// The relative index of the dielectric base for rules that do not refract the cosine.
double Unweighted(const OpenPbrMaterial& m) {
  return Lerp(m.specular_ior, m.specular_ior / m.coat_ior, m.coat_weight);
}

// The average reflectance of a dielectric as Adobe's library fits it.
double FittedAverage(double eta) {
  return eta > 1 ? (eta - 1) / (4.08567 + 1.00071 * eta)
                 : 0.997118 + eta * (0.1014 - eta * (0.965241 + eta * 0.130607));
}

// E_b and r_b as the specification estimates them [Coat / Darkening].
void EstimateBase(const OpenPbrMaterial& m, CoatTransmission* coat) {
  const double f0 = FresnelCoatedDielectric(1.0, 0.0, DielectricOf(m));
  const double weight = std::min(m.specular_weight, 1.0);
  const bool is_factor = m.options.specular_weight_rule == SpecularWeightRule::kFactor;
  const double reflected = is_factor ? weight * f0 : f0;
  const Rgb diffuse = DiffuseColor(m);
  coat->base_albedo = MakeRgb([&](int c) {
    const double of_metal = m.base_weight * m.base_color[c];
    const double dielectric = m.specular_color[c] * reflected + (1 - reflected) * diffuse[c];
    return Lerp(dielectric, weight * of_metal, m.base_metalness);
  });
  const double unweighted = FresnelF0(Unweighted(m), 0.0);
  const double of_dielectric =
      Lerp(1, m.specular_roughness, std::min(m.specular_weight * unweighted, 1.0));
  coat->base_roughness = Lerp(of_dielectric, m.specular_roughness, m.base_metalness);
}

void DarkenAsAdobe(const OpenPbrMaterial& m, CoatTransmission* coat) {
  const double average = FittedAverage(m.coat_ior);
  coat->of_smooth_base = average;
  coat->of_rough_base = InternalDiffuseReflectance(average, m.coat_ior);
  const double specular = FittedAverage(DielectricOf(m).eta);
  coat->base_roughness = Lerp(1, RoughnessBelowCoat(m), Lerp(specular, 1, m.base_metalness));
  const Rgb diffuse = DiffuseColor(m);
  coat->base_albedo = MakeRgb([&](int c) {
    const double rho = m.base_weight * m.base_color[c];
    const double metal =
        m.specular_weight * AverageF82(rho, F82SlopeFromTint(rho, m.specular_color[c]));
    return Lerp(Lerp(diffuse[c], 1, specular), metal, m.base_metalness);
  });
}

void DarkenAsMaterialX(const OpenPbrMaterial& m, CoatTransmission* coat) {
  const double f0 = FresnelF0(m.coat_ior, 0.0);
  coat->of_smooth_base = coat->of_rough_base = InternalDiffuseReflectance(f0, m.coat_ior);
  coat->base_albedo = m.base_color * Lerp(1, m.specular_weight, m.base_metalness);
}

}  // namespace

void EstimateBelowCoat(const OpenPbrMaterial& material, CoatTransmission* coat) {
  switch (material.options.coat_darkening_rule) {
    case CoatDarkening::kSpec:
    case CoatDarkening::kSpec12:
      return EstimateBase(material, coat);
    case CoatDarkening::kMaterialX:
      return DarkenAsMaterialX(material, coat);
    case CoatDarkening::kAdobe:
      return DarkenAsAdobe(material, coat);
  }
}

CoatTransmission TransmissionOf(const OpenPbrMaterial& m) {
  CoatTransmission coat{.weight = m.coat_weight,
                        .color = m.coat_color,
                        .partial = m.options.coat_partial,
                        .darkening = m.coat_darkening,
                        .eta = m.coat_ior};
  if (m.options.coat_absorption == CoatAbsorption::kPath) coat.inverse_eta = 1 / m.coat_ior;
  coat.of_rough_base = InternalDiffuseReflectance(AverageDielectric(m.coat_ior), m.coat_ior);
  coat.absorbs_inside = m.options.coat_darkening_rule == CoatDarkening::kSpec12;
  EstimateBelowCoat(m, &coat);
  return coat;
}

Rgb DiffuseColor(const OpenPbrMaterial& m) {
  return MakeRgb([&](int c) {
    return DeriveDiffuseBase(m.base_weight * m.base_color[c], m.subsurface_color[c],
                             m.subsurface_weight);
  });
}

double WeightInRho(const OpenPbrMaterial& material, double metalness) {
  return material.options.base_weight_in_rho ? material.base_weight * (1 - metalness) : 1;
}

double RelativeIndexBelow(const OpenPbrMaterial& material, double above) {
  return WeightedIndex(material.specular_ior / above, IndexWeight(material));
}

Substrate MetalBelow(FilmMetal rule, double f0, double tint) {
  switch (rule) {
    case FilmMetal::kGulbrandsenTint:
      return GulbrandsenIndex(f0, tint, 0.99);
    case FilmMetal::kRealIndex:
      return RealIndex(f0);
    case FilmMetal::kGulbrandsenF82:
      break;
  }
  const double seventh = 1.0 / 7;
  return GulbrandsenIndex(f0, FresnelF82(seventh, 1 - seventh, f0, F82SlopeFromTint(f0, tint)));
}

bool ChangesMetal(const OpenPbrMaterial& material) {
  return material.options.coat_metal == CoatMetal::kGulbrandsen && material.coat_weight > 0;
}

MicrofacetColors WithMetalBelowCoat(const OpenPbrMaterial& material, double specular_color,
                                    MicrofacetColors at) {
  const Substrate metal = MetalBelow(material.options.film_metal, at.metal_f0, specular_color);
  const double coat = material.coat_ior;
  at.metal_f0 =
      Lerp(at.metal_f0, FresnelF0(metal.eta / coat, metal.k / coat), material.coat_weight);
  at.f82_slope = F82SlopeFromTint(at.metal_f0, specular_color);
  return at;
}

CoatedDielectric<double> DielectricOf(const OpenPbrMaterial& material) {
  const double base = material.specular_ior, coat = material.coat_ior;
  const double weight = IndexWeight(material), coverage = material.coat_weight;
  const auto in_air = [&](double eta) {
    return CoatedDielectric<double>{.eta = WeightedIndex(eta, weight)};
  };
  switch (coverage > 0 ? material.options.coat_fresnel : CoatFresnel::kNone) {
    case CoatFresnel::kRefractCosine:
      return {.eta = WeightedIndex(base, weight),
              .coat = coverage,
              .eta_in_coat = WeightedIndex(base / coat, weight),
              .inverse_coat_eta = 1 / coat};
    case CoatFresnel::kInvertRatio:
      return in_air(Lerp(base, std::max(base / coat, coat / base), coverage));
    case CoatFresnel::kIndexLerp: {
      const double above = Lerp(1, coat, coverage);
      const double below = above * WeightedIndex(base / above, weight);
      return {.eta = above > below && below >= 1 ? above / below : below / above};
    }
    case CoatFresnel::kNone:
      break;
  }
  return in_air(base);
}

}  // namespace nacre
