// SPDX-License-Identifier: Apache-2.0
// image_io/hdr_reader.h: Radiance pictures.
#pragma once

#include <string>

#include "image_io/image_file.h"

namespace nacre {

// Opens a Radiance file of RGBE or XYZE pixels, whose rows may be plain, run-length encoded, or use
// the repetitions of the oldest files (Ward 1991, "Real Pixels", and RADIANCE's
// ray/src/common/color.c and resolu.c). Channels R G B, metadata["transfer"] = "linear", and the
// header's variables as metadata.
//
// The header is honoured: all eight orientations of the resolution string; EXPOSURE and COLORCORR
// (each may occur several times, and multiplies) are divided out, so that values are radiance. XYZE
// pixels are converted as by ra_xyze -r. PRIMARIES other than Radiance's own become the metadata
// "chromaticities". PIXASPECT, which multiplies as well, becomes pixelAspectRatio, its reciprocal.
// FORMAT may be missing: RADIANCE's own programs take such files as RGBE, too.
//
// Throws Error (kBadInput) for GAMMA other than 1, and for a broken file.
ImageFile OpenHdr(const std::string& path);

}  // namespace nacre
