// SPDX-License-Identifier: Apache-2.0
// image_io/verify_image.h: whether an image file is whole, without holding it in memory.
#pragma once

#include <string>

namespace nacre {

// Reads all of the file, from its disk where it can, and decodes it. Of EXR files the checksum is
// compared, if there is one; of PNG files those of all chunks and of the pixels. Returns what it
// went by, for people. Throws Error (kBadInput) for a file that is damaged, cut off or no image.
std::string VerifyImage(const std::string& path);

}  // namespace nacre
