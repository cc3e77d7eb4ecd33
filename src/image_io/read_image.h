// SPDX-License-Identifier: Apache-2.0
// image_io/read_image.h: opens and reads image files of any format that nacre knows, for all
// commands.
#pragma once

#include <string>
#include <vector>

#include "base/image.h"
#include "image_io/image_file.h"

namespace nacre {

// Opens a file. `part` is the only part of an EXR file to read, whose channels then keep their own
// names; "": all parts.
//
// header.metadata["transfer"] says what values mean: "linear", or "display" for formats of integer
// samples, whose values are those of the file scaled to [0, 1], with no transfer curve undone.
// Throws Error: kBadInput if the file cannot be read, has no such part, or has parts that cannot be
// read (deep, subsampled) and none is chosen; kInternal if OpenImageIO cannot be loaded.
ImageFile OpenImage(const std::string& path, const std::string& part = {});

// All parts of a file, including those that cannot be read.
std::vector<ImagePart> DescribeImage(const std::string& path);

// Reads the whole image into memory, 4 bytes per sample. Throws as OpenImage does, and for damaged
// samples.
Image ReadImage(const std::string& path, const std::string& part = {});
Image ReadImage(const ImageFile& file);

// Checks that an image file is intact, without holding it in memory: reads the whole file, from
// disk if possible, and decodes it. For EXR files, the checksum is compared, if there is one; for
// PNG files, those of all chunks and of the pixels. Returns what was checked, in words. Throws
// Error (kBadInput) for a file that is damaged, cut off or not an image. In verify_image.cc.
std::string VerifyImage(const std::string& path);

}  // namespace nacre
