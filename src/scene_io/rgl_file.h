// SPDX-License-Identifier: Apache-2.0
// scene_io/rgl_file.h: reads BRDFs of EPFL's database (.bsdf), whose files are lists of named
// arrays.
#pragma once

#include <string>
#include <string_view>

#include "brdf/measured_table.h"

namespace nacre {

// Whether a file that begins so is a list of arrays.
bool IsTensorFile(std::string_view head);

// Larger files are refused: those of the database have up to 80 MB. In memory, tables take up to
// three times the bytes of a file.
inline constexpr uint64_t kMaxRglBytes = uint64_t{1} << 28;

// Reads a whole file. Spectra are converted to Rec. 709 under D65; what lies outside of its gamut
// is clipped. Throws Error (kBadInput), located in `file`.
MeasuredBrdf ReadRgl(std::string_view bytes, const std::string& file);

}  // namespace nacre
