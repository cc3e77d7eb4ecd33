// SPDX-License-Identifier: Apache-2.0
// image_io/exr_check.h: checks EXR files before OpenEXR's C++ reader, which trusts them: it
// allocates what a header promises, and leaves samples uninitialised where a chunk is too short or
// inflates to too little.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>

namespace nacre {

// Throws Error (kBadInput) if the header of an EXR file contradicts the size of the file or itself.
void CheckExrHeader(const std::string& path);

// Checks the chunks of a part that is neither deep nor subsampled, at full resolution. Throws Error
// (kBadInput) for chunks that are missing, reach beyond the end of the file, or do not hold as many
// samples as the header says, and for chunks and rows of tiles with more samples than
// CheckSampleCount allows.
void CheckExrChunks(const std::string& path, int part, uint64_t file_bytes);

// The samples of some rows in the file's layout: row by row, and channel by channel within a row.
struct ExrChunkRows {
  int y = 0, rows = 0;
  std::span<const uint16_t> words;
};

// Checks the chunks of a part of scanlines that is compressed by ZIP or ZIPS, and calls use() with
// the inflated contents of each, in parallel from several threads, so that chunks are inflated only
// once. Returns false for other parts, which it does not check.
bool DecodeExrLines(const std::string& path, int part, uint64_t file_bytes,
                    const std::function<void(const ExrChunkRows&)>& use);

}  // namespace nacre
