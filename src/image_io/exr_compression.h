// SPDX-License-Identifier: Apache-2.0
// image_io/exr_compression.h: the compressions of EXR files that nacre writes: their names, their
// numbers in files and their rows per chunk.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace nacre {

enum class Compression : uint8_t {
  kNone,
  kZip,   // lossless, 16 rows per chunk
  kZips,  // lossless, 1 row per chunk
  kPiz,   // lossless, 32 rows per chunk: wavelets, for noisy pictures
  kDwaa,  // lossy in R, G and B of every layer, 32 rows per chunk
};

// "none", "zip", "zips", "piz", "dwaa".
std::vector<std::string> CompressionNames();
std::string CompressionName(Compression compression);

// Throws Error (kUsage) for other names.
Compression ParseCompression(const std::string& name);

// The rows of a chunk, which are counted from the top of the data window; the last one may have
// fewer.
int RowsPerChunk(Compression compression);

// The number of the compression in files, in OpenEXR's Imf::Compression and in exr_compression_t.
int CompressionNumber(Compression compression);
// nullopt for a compression that nacre does not write.
std::optional<Compression> CompressionOfNumber(int number);

}  // namespace nacre
