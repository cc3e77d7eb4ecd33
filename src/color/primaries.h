// SPDX-License-Identifier: Apache-2.0
// color/primaries.h: the primaries and the white that colours of a file refer to, and the way from
// there to linear Rec. 709.
#pragma once

#include <optional>
#include <string_view>

#include "base/vec.h"

namespace nacre {

// Chromaticities x and y.
struct Primaries {
  Vec2d red, green, blue, white;
};

// ITU-R BT.709-6, table 1.
inline constexpr std::string_view kRec709Primaries = "0.64 0.33 0.3 0.6 0.15 0.06 0.3127 0.329";

// From x and y of red, green, blue and white, as EXR's "chromaticities" and Radiance's PRIMARIES
// have them. Nothing if they are none: not eight numbers, primaries on one line (Photoshop writes
// eight zeros), or a white that light of the primaries cannot mix.
std::optional<Primaries> ParsePrimaries(std::string_view text);

// How far a coordinate of the same primary may be off in another file: three digits are off by
// 5e-4, and there is a white of .3127 .3290 and of .3128 .3292.
inline constexpr double kPrimariesError = 1e-3;

bool SamePrimaries(const Primaries& a, const Primaries& b);

// rgb * the matrix is the colour's XYZ; the Y of white is 1.
Imath::M33d XyzFromRgb(const Primaries& primaries);

// rgb * the matrix is the colour in linear Rec. 709: by XYZ (SMPTE RP 177-1993), and from the one
// white to the other by the linear Bradford transform (Lam 1985; ICC.1:2022, annex E), so that grey
// stays grey. Where the primaries are X, Y and Z themselves, the white is none that anybody has
// adapted to, and is left alone: OpenEXR's test images Rec709.exr and XYZ.exr are one picture so.
Imath::M33d Rec709FromPrimaries(const Primaries& primaries);

}  // namespace nacre
