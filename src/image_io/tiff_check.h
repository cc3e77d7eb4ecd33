// SPDX-License-Identifier: Apache-2.0
// image_io/tiff_check.h: finds data that a TIFF file lacks and that libtiff would silently make up.
// It is not a reader: files that libtiff itself refuses are left to it.
#pragma once

#include <string>

namespace nacre {

// What the first image of a TIFF file (TIFF 6.0 and BigTIFF) lacks of the data of its pixels, in
// words; "" if nothing. libtiff takes palette indices without a palette for grey, and reads beyond
// the end of uncompressed strips that are too short.
std::string WhatTiffLacks(const std::string& path);

}  // namespace nacre
