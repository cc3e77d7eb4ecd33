// SPDX-License-Identifier: Apache-2.0
// image_io/verify_image.h: checks that an image file is intact, without holding it in memory.
#pragma once

#include <string>

namespace nacre {

// Reads the whole file, from disk if possible, and decodes it. For EXR files, the checksum is
// compared, if there is one; for PNG files, those of all chunks and of the pixels. Returns what was
// checked, in words. Throws Error (kBadInput) for a file that is damaged, cut off or not an image.
std::string VerifyImage(const std::string& path);

}  // namespace nacre
