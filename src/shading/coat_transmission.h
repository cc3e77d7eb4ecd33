// SPDX-License-Identifier: Apache-2.0
// shading/coat_transmission.h: what a coat lets through of the light that lies below it: what its
// lobe does not reflect, less what its medium absorbs, and what is reflected back inside it. SIMD
// twin: CoverByCoat in cover_kernel.cc.
#pragma once

#include "base/vec.h"
#include "scene/open_pbr.h"

namespace nacre {

struct CoatTransmission {
  double weight = 1;  // the fraction of what is below that the coat covers, in [0, 1]
  // The transmittance of the coat's medium there and back, at normal incidence, each in [0, 1].
  Rgb color{1, 1, 1};
  CoatPartial partial = CoatPartial::kLerpThenExponent;
  // Of the coat's index, by which it refracts the paths of light; 0 where all paths are as long as
  // at normal incidence.
  double inverse_eta = 0;
  // The darkening by light that is reflected inside the coat (OpenPBR Surface 1.1.1, Coat,
  // Darkening): its amount, the coat's index, the fraction of light that is reflected back to a
  // smooth base, which if it is below 0 follows from the view, and to a rough base; how rough the
  // base is, in [0, 1]; and its albedo.
  double darkening = 0;
  double eta = 1, of_smooth_base = -1, of_rough_base = 0;
  double base_roughness = 1;
  Rgb base_albedo{0, 0, 0};
  bool absorbs_inside = false;  // also what is reflected inside
};

// The factor on what is below is constant + along_light * CrossingOfLight.
struct CoatFactors {
  Rgb constant{0, 0, 0}, along_light{1, 1, 1};
};

// The colour of the medium, of which a coat of partial weight may be a thinner one.
Rgb MediumOf(const CoatTransmission& coat);

// Whether CrossingOfLight depends on the direction of light.
bool AbsorbsAlongLight(const CoatTransmission& coat);

// `albedo` is that of the coat's lobe, its weight included, at n.v.
CoatFactors FactorsOf(const CoatTransmission& coat, const Rgb& albedo, double n_dot_v);

// The transmittance of the medium on the way of light from n.l.
Rgb CrossingOfLight(const CoatTransmission& coat, double n_dot_l);

// The factor as a whole.
inline Rgb TransmittedByCoat(const CoatTransmission& coat, const Rgb& albedo, double n_dot_v,
                             double n_dot_l) {
  const CoatFactors factors = FactorsOf(coat, albedo, n_dot_v);
  return factors.constant + factors.along_light * CrossingOfLight(coat, n_dot_l);
}

// The factor on what is emitted below the coat, seen from n.v. `albedo` as in FactorsOf.
Rgb EmittedThroughCoat(EmissionThrough rule, const CoatTransmission& coat, const Rgb& albedo,
                       double n_dot_v);

}  // namespace nacre
