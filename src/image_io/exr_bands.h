// SPDX-License-Identifier: Apache-2.0
// image_io/exr_bands.h: EXR files that each hold a band of a picture's rows, and the file that they
// make together: chunks are copied as they are, never decoded.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "image_io/exr_compression.h"
#include "image_io/exr_header.h"

namespace nacre {

// What ExrWriter was told when it wrote the file.
struct ExrBandHeader {
  ExrHeader header;
  Compression compression = Compression::kZip;
};

// One file, open. One thread at a time. All functions throw Error (kBadInput).
class ExrBandReader {
 public:
  // Throws for a file that is missing, malformed, or of a kind that ExrWriter does not write.
  explicit ExrBandReader(const std::string& path);
  ~ExrBandReader();

  ExrBandHeader ReadHeader() const;

  // The compressed bytes of the chunk that begins at row `y`. Throws if it is not in the file.
  std::vector<uint8_t> ReadChunk(int y);

  // Decodes every sample: throws if any chunk is not what the header says. Bits that flipped where
  // a compression keeps no check of its own stay unnoticed: CheckExrChecksum notices them.
  void DecodeAll();

  // Rows y .. y + rows - 1 of a channel each, decoded to floats.
  void ReadRows(int y, int rows, const std::vector<std::string>& channels,
                std::vector<std::vector<float>>* planes);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// A file being put together from bands, from the top down. Throws Error: kCannotWrite as ExrWriter
// does.
class ExrBandWriter {
 public:
  ExrBandWriter(const std::string& path, const ExrBandHeader& header);
  // Without Finish, nothing remains of the file.
  ~ExrBandWriter();

  void WriteChunk(int y, const std::vector<uint8_t>& bytes);

  // After the last chunk: the file appears, once it has reached the disk: tiles are deleted for it.
  void Finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace nacre
