// SPDX-License-Identifier: Apache-2.0
// study/rounding.h: measures errors of hits and highlights, by formula and precision.
#pragma once

#include <cstdint>
#include <optional>

#include "base/vec.h"

namespace nacre {

enum class HitForm : uint8_t {
  kTextbookFloat,  // t = (-b - sqrt(b^2 - 4 a c)) / 2 a
  kTextbookDouble,
  kStableFloat,  // visibility/sphere_test.h in float, which finds candidates
  kNacre,        // visibility/sphere_test.h in double, which decides
};

// The normal where the ray hits the sphere of radius 1 about `center`; nullopt if it misses.
std::optional<Vec3d> HitNormal(HitForm form, const Vec3d& center, const Vec3d& direction);

struct HitError {
  double wrong = 0;   // fraction of rays that wrongly hit or miss
  double normal = 0;  // rms angle in radians between the computed and the true normals of true hits
};

// Measures errors over rays at a sphere and just past it, for a centre at this distance in radii,
// against a reference with 64-bit mantissas.
HitError MeasureHits(HitForm form, double distance);

enum class GgxForm : uint8_t {
  kTextbookFloat,   // (n.h)^2 (alpha^2 - 1) + 1 from float vectors
  kTextbookDouble,  // the same formula in double
  kNacre,           // the SIMD kernel, in float
};

// The largest relative error of the reflected radiance within three widths of the peak. For the
// textbook form, infinite if its denominator is 0.
double MeasureGgx(GgxForm form, double roughness);

}  // namespace nacre
