// SPDX-License-Identifier: Apache-2.0
#include "shading/coat_transmission.h"

#include <cmath>

#include "brdf/fresnel.h"
#include "brdf/open_pbr.h"

namespace nacre {
namespace {

Rgb Lerp(const Rgb& a, const Rgb& b, double t) { return a + (b - a) * t; }

Rgb Crossing(const CoatTransmission& coat, double cosine) {
  const double refracted = RefractedCosine(cosine, coat.inverse_eta);
  const Rgb medium = MediumOf(coat);
  return MakeRgb([&](int c) { return CoatCrossing(medium[c], refracted); });
}

Rgb DarkeningOf(const CoatTransmission& coat, double n_dot_v) {
  const double smooth = coat.of_smooth_base >= 0
                            ? coat.of_smooth_base
                            : FresnelDielectric(n_dot_v, 1 - n_dot_v, coat.eta);
  const double k = smooth + (coat.of_rough_base - smooth) * coat.base_roughness;
  return MakeRgb([&](int c) {
    return CoatDarkeningFactor(coat.base_albedo[c], k, coat.absorbs_inside ? coat.color[c] : 1.0);
  });
}

}  // namespace

Rgb MediumOf(const CoatTransmission& coat) {
  return coat.partial == CoatPartial::kLerpThenExponent ? Lerp(Rgb(1), coat.color, coat.weight)
                                                        : coat.color;
}

bool AbsorbsAlongLight(const CoatTransmission& coat) {
  return coat.color != Rgb(1) && coat.inverse_eta > 0;
}

CoatFactors FactorsOf(const CoatTransmission& coat, const Rgb& albedo, double n_dot_v) {
  const double weight = coat.weight;
  const Rgb left = Rgb(1) - albedo;
  const Rgb covered = left - Rgb(1 - weight);  // weight times what a whole coat leaves
  const Rgb crossing = Crossing(coat, n_dot_v);
  const bool darkens = coat.darkening > 0;
  const Rgb whole = darkens ? Lerp(Rgb(1), DarkeningOf(coat, n_dot_v), coat.darkening) : Rgb(1);
  if (coat.partial == CoatPartial::kWholeProduct) {
    return {Rgb(1 - weight), covered * crossing * whole};
  }
  const Rgb darkened = Lerp(Rgb(1), whole, weight);
  switch (coat.partial) {
    case CoatPartial::kExponentThenLerp:
      return {darkened * (1 - weight), covered * crossing * darkened};
    case CoatPartial::kPerCrossing: {
      const Rgb both = Lerp(Rgb(1), crossing, weight) * left * darkened;
      return {both * (1 - weight), both * weight};
    }
    case CoatPartial::kLerpThenExponent:
    case CoatPartial::kWholeProduct:
      break;
  }
  return {Rgb(0), left * crossing * darkened};
}

Rgb EmittedThroughCoat(EmissionThrough rule, const CoatTransmission& coat, const Rgb& albedo,
                       double n_dot_v) {
  const Rgb medium = Crossing(coat, n_dot_v);
  // The medium of kLerpThenExponent has the coat's weight in it.
  const Rgb crossing =
      coat.partial == CoatPartial::kLerpThenExponent ? medium : Lerp(Rgb(1), medium, coat.weight);
  switch (rule) {
    case EmissionThrough::kCoatPath:
      return crossing;
    case EmissionThrough::kCoatColor:
      return Lerp(Rgb(1), coat.color, coat.weight);
    case EmissionThrough::kMaterialX: {
      const double left = (1 - FresnelF0(coat.eta, 0.0)) * (1 - std::pow(1 - n_dot_v, 5));
      return Lerp(Rgb(1), coat.color * left, coat.weight);
    }
    case EmissionThrough::kBaseFactors:
      break;
  }
  const bool darkens = coat.darkening > 0;
  const double amount = coat.weight * coat.darkening;
  const Rgb darkened = darkens ? Lerp(Rgb(1), DarkeningOf(coat, n_dot_v), amount) : Rgb(1);
  return (Rgb(1) - albedo) * crossing * darkened;
}

Rgb CrossingOfLight(const CoatTransmission& coat, double n_dot_l) {
  return Crossing(coat, n_dot_l);
}

}  // namespace nacre
