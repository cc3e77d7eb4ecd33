// SPDX-License-Identifier: Apache-2.0
// image_io/exr_bands.h: reads EXR files that each hold a band of a picture's rows. ExrContainer
// joins them to one file, to which their chunks are copied without decoding them.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <OpenEXR/ImfForward.h>

#include "image_io/exr_compression.h"
#include "image_io/exr_header.h"

namespace nacre {

// The settings with which ExrWriter wrote the file.
struct ExrBandHeader {
  ExrHeader header;
  Compression compression = Compression::kZip;
};

// An open file, to be used by one thread at a time. All functions throw Error (kBadInput).
class ExrBandReader {
 public:
  // Throws for a file that is missing, malformed, or not like those that ExrWriter writes.
  explicit ExrBandReader(const std::string& path);
  ~ExrBandReader();

  ExrBandHeader ReadHeader() const;

  // The compressed bytes of the chunk that begins at row `y`. Throws if the file does not have it.
  std::vector<uint8_t> ReadChunk(int y);

  // Decodes every sample. Throws if any chunk contradicts the header. Flipped bits remain unnoticed
  // if the compression has no checksum; CheckExrChecksum finds them.
  void DecodeAll();

  // Decodes rows y .. y + rows - 1 of the named channels to floats, one plane for each channel.
  void ReadRows(int y, int rows, const std::vector<std::string>& channels,
                std::vector<std::vector<float>>* planes);

 private:
  std::string path_;
  std::unique_ptr<Imf::InputFile> file_;
};

}  // namespace nacre
