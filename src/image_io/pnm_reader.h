// SPDX-License-Identifier: Apache-2.0
// image_io/pnm_reader.h: the portable pixel maps of Netpbm, and PFM.
#pragma once

#include <string>

#include "image_io/image_file.h"

namespace nacre {

// P1 to P6: bits, greys and colours, as text or binary, of any maximum up to 65535; display values.
// Pf and PF: grey or colour floats of either byte order, rows from the bottom up, multiplied by the
// header's scale; linear values. The first image of a file. Channels Y or R G B.
//
// Throws Error (kBadInput) for files that are cut off or hold what their header does not allow.
// Written out because Netpbm's own library ends the process on such a file, and OpenImageIO reads
// what is missing as anything.
ImageFile OpenPnm(const std::string& path);

}  // namespace nacre
