// SPDX-License-Identifier: Apache-2.0
// image_io/pnm_reader.h: reads the portable pixel maps of Netpbm, and PFM.
#pragma once

#include <string>

#include "image_io/image_file.h"

namespace nacre {

// Opens the first image of a file. P1 to P6: bits, greys and colours, as text or binary, with any
// maximum up to 65535; display values. Pf and PF: grey or colour floats in either byte order, with
// rows from the bottom up, multiplied by the header's scale; linear values. Channels Y or R G B.
//
// Throws Error (kBadInput) for files that are cut off or contradict their header. This reader
// exists because Netpbm's own library ends the process on such a file, and OpenImageIO makes up
// what is missing.
ImageFile OpenPnm(const std::string& path);

}  // namespace nacre
