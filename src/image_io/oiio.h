// SPDX-License-Identifier: Apache-2.0
// image_io/oiio.h: OpenImageIO, loaded when first used.
//
// It is in a module of its own, nacre_oiio.so. The module is looked for beside the file that
// contains this code, program or libnacre.so, and where it is installed relative to that file:
// ../lib/nacre from a program, nacre/ from the library. Neither the working folder nor the
// environment matters.
#pragma once

#include <string>

#include "image_io/image_file.h"

namespace nacre {

// Whether the module exists.
bool HasOiio();

// Opens a TIFF file, with the results and errors of OpenImage: the first page at full resolution.
// Rows are decoded in bands: besides the caller's samples, reading takes memory for a band, and
// what OpenImageIO and libtiff allocate. Orientation tags are honoured.
ImageFile OpenWithOiio(const std::string& path);

}  // namespace nacre
