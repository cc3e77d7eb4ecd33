// SPDX-License-Identifier: Apache-2.0
// image_io/image_reader.h: images of any format into memory.
#pragma once

#include <string>

#include "base/image.h"

namespace nacre {

// EXR through OpenEXR, anything else through OpenImageIO, which is loaded then (0.2 s).
//
// metadata["transfer"] says what values mean: "linear", or "display" for formats of integer
// samples, whose values lie in [0, 1] and are those of the file: no transfer curve is undone.
// Throws Error: kBadInput if the file cannot be read, kInternal if OpenImageIO cannot be loaded.
Image ReadImage(const std::string& path);

}  // namespace nacre
