// SPDX-License-Identifier: Apache-2.0
// study/phong_share.h: how much of the light from one angle Phong's model reflects, in the units
// that it is written in.
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
  kModifiedOverPi,      // the same over pi
  kModifiedNormalised,  // kd / pi and ks (n + 2) / 2 pi (Lafortune and Willems 1994)
};

// cosine: n.l > 0. By quadrature of the lobe.
double PhongShare(const PhongCoefficients& phong, PhongUnits units, double cosine);

}  // namespace nacre
