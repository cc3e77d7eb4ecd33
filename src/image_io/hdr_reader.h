// SPDX-License-Identifier: Apache-2.0
// image_io/hdr_reader.h: plain Radiance pictures into memory without OpenImageIO, whose libraries
// take 0.2 s to load.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "base/image.h"

namespace nacre {

// The image of a Radiance file of RGBE pixels, from the top left on, row by row, each row as it is
// or run by run (Ward 1991, "Real Pixels", and RADIANCE's ray/src/common/color.c). Channels R G B,
// metadata["transfer"] = "linear", and no other metadata; an exposure that the header tells of is
// not taken back.
//
// Nothing for any other file, for a missing or a broken one, and for one of more samples than
// `max_samples`: ReadImage (image_reader.h) knows more kinds, and says what is wrong.
std::optional<Image> ReadPlainHdr(const std::string& path, uint64_t max_samples);

}  // namespace nacre
