// SPDX-License-Identifier: Apache-2.0
// image_io/exr_compression.h: the compressions of EXR files that nacre writes: their names, their
// numbers in files and the rows they take at a time.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace nacre {

enum class Compression : uint8_t {
  kNone,
  kZip,   // lossless, 16 rows a chunk
  kZips,  // lossless, 1 row a chunk
  kPiz,   // lossless, 32 rows a chunk: wavelets, for noisy pictures
  kDwaa,  // lossy in R, G and B of every layer, 32 rows a chunk
};

// "none", "zip", "zips", "piz", "dwaa".
std::vector<std::string> CompressionNames();
std::string CompressionName(Compression compression);

// Throws Error (usage) for a name that is none of these.
Compression ParseCompression(const std::string& name);

// Rows of a chunk, counted from the data window's top; the last one may have fewer.
int RowsPerChunk(Compression compression);

// The number that stands for it in files, and in OpenEXR's Imf::Compression and exr_compression_t.
int CompressionNumber(Compression compression);
// Nothing for one that nacre does not write.
std::optional<Compression> CompressionOfNumber(int number);

}  // namespace nacre
