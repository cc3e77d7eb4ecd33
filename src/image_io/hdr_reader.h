// SPDX-License-Identifier: Apache-2.0
// image_io/hdr_reader.h: Radiance pictures.
#pragma once

#include <string>

#include "image_io/image_file.h"

namespace nacre {

// A Radiance file of RGBE pixels, row by row, each row as it is, run by run, or with the oldest
// files' repetitions (Ward 1991, "Real Pixels", and RADIANCE's ray/src/common/color.c and
// resolu.c). Channels R G B, metadata["transfer"] = "linear", the header's variables as metadata.
//
// What the header says of the pixels is honoured: all eight orientations of the resolution string,
// EXPOSURE and COLORCORR (each may stand several times and multiplies), which are divided out, so
// that values are radiance. Refused are XYZE pixels, PRIMARIES other than Radiance's own and Rec.
// 709's, and GAMMA other than 1. PIXASPECT, which multiplies as well, becomes pixelAspectRatio, its
// reciprocal. FORMAT may be missing: RADIANCE's own programs take such files as RGBE, too.
//
// Throws Error (kBadInput) for these, and for a broken file.
ImageFile OpenHdr(const std::string& path);

}  // namespace nacre
