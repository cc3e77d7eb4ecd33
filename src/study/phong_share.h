// SPDX-License-Identifier: Apache-2.0
// study/phong_share.h: the fraction of light from one angle that Phong's model reflects, depending
// on the units in which it is written.
#pragma once

#include <cstdint>

namespace nacre {

struct PhongCoefficients {
  double kd = 0.8, ks = 0.5, shininess = 64;
};

enum class PhongUnits : uint8_t {
  kLiteral,             // kd n.l + ks (r.v)^n, as lessons write it
  kOverPi,              // both terms over pi
  kModified,            // kd n.l + ks (r.v)^n n.l
  kModifiedOverPi,      // kModified divided by pi
  kModifiedNormalised,  // kd / pi and ks (n + 2) / 2 pi (Lafortune and Willems 1994)
};

// `cosine`: n.l > 0. Integrates the lobe by quadrature.
double PhongShare(const PhongCoefficients& phong, PhongUnits units, double cosine);

}  // namespace nacre
