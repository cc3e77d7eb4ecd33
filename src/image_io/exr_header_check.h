// SPDX-License-Identifier: Apache-2.0
// image_io/exr_header_check.h: checks EXR headers before OpenEXR's C++ reader, which trusts them.
#pragma once

#include <string>

namespace nacre {

// Throws Error (kBadInput) if the header of an EXR file contradicts the size of the file or itself.
void CheckExrHeader(const std::string& path);

}  // namespace nacre
