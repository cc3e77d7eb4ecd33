// SPDX-License-Identifier: Apache-2.0
#include "scene/open_pbr.h"

#include <algorithm>
#include <cmath>

namespace nacre {

OpenPbrOptions OptionsOf(OpenPbrRules rules) {
  switch (rules) {
    case OpenPbrRules::kSpec11:
      break;
    case OpenPbrRules::kSpec12:
      return {.specular_weight_rule = SpecularWeightRule::kIndexReflect,
              .coat_darkening_rule = CoatDarkening::kSpec12,
              .coat_partial = CoatPartial::kWholeProduct};
    case OpenPbrRules::kMaterialX:
      return {.coat_fresnel = CoatFresnel::kInvertRatio,
              .coat_darkening_rule = CoatDarkening::kMaterialX,
              .coat_absorption = CoatAbsorption::kNormal,
              .coat_partial = CoatPartial::kLerpThenExponent,
              .compensation = Compensation::kTurquin,
              .film = ThinFilmForm::kBelcourBarla,
              .film_metal = FilmMetal::kRealIndex,
              .film_outside = FilmOutside::kAir,
              .emission_through = EmissionThrough::kMaterialX};
    case OpenPbrRules::kAdobe:
      return {.coat_fresnel = CoatFresnel::kIndexLerp,
              .coat_roughening = CoatRoughening::kAdobe,
              .coat_darkening_rule = CoatDarkening::kAdobe,
              .coat_partial = CoatPartial::kPerCrossing,
              .layering = Layering::kReciprocal,
              .smith = Shadowing::kSeparable,
              .alpha_max = AlphaLimit::kNone,
              .film = ThinFilmForm::kLines,
              .film_metal = FilmMetal::kGulbrandsenTint,
              .emission_through = EmissionThrough::kBaseFactors,
              .film_fade_nm = 30,
              .base_weight_in_rho = true};
  }
  return {};
}

// By the material's own numbers: maps of fuzz are not looked up for its coat.
double CoatRoughnessOf(const OpenPbrMaterial& m) {
  const double c = m.coat_roughness;
  if (m.options.coat_roughening != CoatRoughening::kAdobe || !(m.fuzz_weight > 0)) return c;
  const double mean = (m.fuzz_color.x + m.fuzz_color.y + m.fuzz_color.z) / 3;
  const double widened = std::pow(c, 4) + 0.005 * mean * std::pow(m.fuzz_roughness, 5);
  return c + (std::pow(std::min(widened, 1.0), 0.25) - c) * m.fuzz_weight;
}

OpenPbrMaterial DefaultsOf(OpenPbrVersion version) {
  if (version == OpenPbrVersion::k11) return {};
  return {.options = OptionsOf(OpenPbrRules::kSpec12),
          .emission_weight = 0,
          .emission_luminance = 1000};
}

}  // namespace nacre
