// SPDX-License-Identifier: Apache-2.0
// study/fresnel_angles.h: the angles at which an interface has a given reflectance.
#pragma once

namespace nacre {

struct FresnelAngle {
  double cosine = 0, degrees = 0;
};

// For Schlick's curve: cos = 1 - ((F - F0) / (1 - F0))^(1/5), for F >= F0.
FresnelAngle SchlickAngle(double f0, double reflectance);

// For the exact curve of a dielectric with index eta > 1, which increases monotonically, by
// bisection; reflectance >= F0.
FresnelAngle DielectricAngle(double eta, double reflectance);

// The largest |Schlick - exact| over the cosine, and the cosine where it occurs; k = 0 is a
// dielectric.
struct FresnelGap {
  double difference = 0, cosine = 0;
};
FresnelGap LargestSchlickError(double eta, double k);

}  // namespace nacre
