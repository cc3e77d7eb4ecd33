// SPDX-License-Identifier: Apache-2.0
// image_io/exr_header_check.h: EXR headers that may be given to OpenEXR's C++ reader, which
// believes them.
#pragma once

#include <string>

namespace nacre {

// Throws Error (kBadInput) if the header of an EXR file says what the file cannot hold.
void CheckExrHeader(const std::string& path);

}  // namespace nacre
