// SPDX-License-Identifier: Apache-2.0
// color/primaries.h: the primaries and the white that the colours of a file refer to, and their
// conversion to linear Rec. 709.
#pragma once

#include <optional>
#include <string_view>

#include "base/vec.h"

namespace nacre {

// CIE 1931 chromaticities x and y.
struct Primaries {
  Vec2d red, green, blue, white;
};

// ITU-R BT.709-6, table 1.
inline constexpr std::string_view kRec709Primaries = "0.64 0.33 0.3 0.6 0.15 0.06 0.3127 0.329";

// Parses x and y of red, green, blue and white, in the order of EXR's "chromaticities" and
// Radiance's PRIMARIES. Returns nothing if the text is not eight numbers, if the primaries are
// collinear (Photoshop writes eight zeros), or if the primaries cannot mix the white.
std::optional<Primaries> ParsePrimaries(std::string_view text);

// The largest difference between the coordinates of one primary in two files: rounding to three
// digits is off by 5e-4, and the same white is given as .3127 .3290 and as .3128 .3292.
inline constexpr double kPrimariesError = 1e-3;

bool SamePrimaries(const Primaries& a, const Primaries& b);

// rgb * the matrix is the colour's XYZ; the Y of white is 1.
Imath::M33d XyzFromRgb(const Primaries& primaries);

// rgb * the matrix is the colour in linear Rec. 709. The conversion goes through XYZ (SMPTE RP
// 177-1993), and adapts one white to the other by the linear Bradford transform (Lam 1985;
// ICC.1:2022, annex E), so that grey stays grey. Where the primaries are X, Y and Z themselves,
// nobody has adapted to the white, and the conversion does not either: OpenEXR's test images
// Rec709.exr and XYZ.exr then are one picture.
Imath::M33d Rec709FromPrimaries(const Primaries& primaries);

}  // namespace nacre
