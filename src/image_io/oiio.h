// SPDX-License-Identifier: Apache-2.0
// image_io/oiio.h: OpenImageIO, loaded when first used.
//
// It is in a module of its own, nacre_oiio.so, which is looked for beside the file that this code
// is in, program or libnacre.so, and where it is installed as seen from that file: ../lib/nacre
// from a program, nacre/ from the library. Not in the working folder, nor by anything in the
// environment.
#pragma once

#include <string>

#include "image_io/image_file.h"

namespace nacre {

// Whether the module is there.
bool HasOiio();

// TIFF, as OpenImage says. First page, full resolution. Rows are decoded in
// bands: beside the caller's samples, reading takes memory for a band, and whatever OpenImageIO and
// the format's library do. Orientation tags are honoured.
ImageFile OpenWithOiio(const std::string& path);

}  // namespace nacre
