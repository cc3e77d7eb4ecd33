// SPDX-License-Identifier: Apache-2.0
// image_io/exr_chunk_check.h: whether the chunks of an EXR file are whole, before OpenEXR's C++
// reader sees them: it allocates what a header promises, and leaves samples uninitialised where a
// chunk is too short or inflates to too little.
#pragma once

#include <cstdint>
#include <string>

namespace nacre {

// Of a part that is neither deep nor subsampled, at full resolution. Throws Error (kBadInput) for
// chunks that are missing, that reach beyond the file, or whose samples are not as many as the
// header says; for chunks and rows of tiles of more samples than CheckSampleCount allows.
void CheckExrChunks(const std::string& path, int part, uint64_t file_bytes);

}  // namespace nacre
