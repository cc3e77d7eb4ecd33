// SPDX-License-Identifier: Apache-2.0
// image_io/tiff_check.h: what libtiff makes up where a TIFF file lacks it, and nobody is told of.
// Not a reader: what libtiff refuses itself is left to it.
#pragma once

#include <string>

namespace nacre {

// Of the first image of a TIFF file (TIFF 6.0, and BigTIFF), what it lacks of what its pixels are
// made of: "" if nothing. Libtiff reads palette indices without a palette as grey, and uncompressed
// strips that are too short on into what follows them in the file.
std::string WhatTiffLacks(const std::string& path);

}  // namespace nacre
