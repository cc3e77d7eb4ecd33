// SPDX-License-Identifier: Apache-2.0
// study/rounding.h: how far hits and highlights are from the truth, by formula and precision.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/vec.h"

namespace nacre {

enum class HitForm : uint8_t {
  kTextbookFloat,  // t = (-b - sqrt(b^2 - 4 a c)) / 2 a
  kTextbookDouble,
  kStableFloat,  // visibility/sphere_test.h in float, which proposes hits
  kNacre,        // the same in double, which decides them
};

// The normal where the ray hits the sphere of radius 1 about `center`, or nothing.
std::optional<Vec3d> HitNormal(HitForm form, const Vec3d& center, const Vec3d& direction);

struct HitError {
  double wrong = 0;   // share of the rays that hit and should not, or the other way round
  double normal = 0;  // rms angle between the normals of true hits, in radians
};

// Over rays at a sphere and just past it, its centre at this distance in radii, against 64-bit
// mantissas.
HitError MeasureHits(HitForm form, double distance);

enum class GgxForm : uint8_t {
  kTextbookFloat,   // (n.h)^2 (alpha^2 - 1) + 1 from float vectors
  kTextbookDouble,  // the same in double
  kNacre,           // the SIMD kernel's float
};

// The largest relative error of the reflected radiance within three widths of the peak; of the
// textbook's form infinite where its denominator is 0.
double MeasureGgx(GgxForm form, double roughness);

}  // namespace nacre
