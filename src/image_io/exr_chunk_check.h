// SPDX-License-Identifier: Apache-2.0
// image_io/exr_chunk_check.h: whether the chunks of an EXR file are whole, before OpenEXR's C++
// reader sees them: it allocates what a header promises, and leaves samples uninitialised where a
// chunk is too short or inflates to too little.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>

namespace nacre {

// Of a part that is neither deep nor subsampled, at full resolution. Throws Error (kBadInput) for
// chunks that are missing, that reach beyond the file, or whose samples are not as many as the
// header says; for chunks and rows of tiles of more samples than CheckSampleCount allows.
void CheckExrChunks(const std::string& path, int part, uint64_t file_bytes);

// The samples of some rows as they stand in the file: row after row, channel after channel.
struct ExrChunkRows {
  int y = 0, rows = 0;
  std::span<const uint16_t> words;
};

// Checks the chunks likewise of a part of lines that nothing but deflate compresses, and calls
// use() with what each holds, from any thread: inflated once, in parallel. Returns false for a part
// of another kind, of which nothing is checked.
bool DecodeExrLines(const std::string& path, int part, uint64_t file_bytes,
                    const std::function<void(const ExrChunkRows&)>& use);

}  // namespace nacre
