// SPDX-License-Identifier: Apache-2.0
// study/fresnel_angles.h: at which angle an interface reflects a given share.
#pragma once

namespace nacre {

struct FresnelAngle {
  double cosine = 0, degrees = 0;
};

// Schlick's curve: cos = 1 - ((F - F0) / (1 - F0))^(1/5), for F >= F0.
FresnelAngle SchlickAngle(double f0, double reflectance);

// The exact curve of a dielectric of this index > 1, which rises all the way, by bisection;
// reflectance >= F0.
FresnelAngle DielectricAngle(double eta, double reflectance);

// The largest |Schlick - exact| over the cosine, and where: k = 0 is a dielectric.
struct FresnelGap {
  double difference = 0, cosine = 0;
};
FresnelGap LargestSchlickError(double eta, double k);

}  // namespace nacre
