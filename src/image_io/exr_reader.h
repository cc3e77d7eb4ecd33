// SPDX-License-Identifier: Apache-2.0
// image_io/exr_reader.h: EXR files into memory, by OpenEXR.
#pragma once

#include <string>

#include "base/image.h"

namespace nacre {

// The first part of a scanline or tiled file (at full resolution, if it has several): all
// channels as floats, ids too, and the header's attributes as text. Throws Error (kBadInput) if
// the file is missing, malformed, truncated, deep or subsampled, or has more than 2 GiB of floats.
Image ReadExr(const std::string& path);

// The same without samples, and of any size.
Image ReadExrHeader(const std::string& path);

}  // namespace nacre
