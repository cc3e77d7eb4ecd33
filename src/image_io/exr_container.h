// SPDX-License-Identifier: Apache-2.0
// image_io/exr_container.h: writes an EXR file from chunks that are compressed already, with
// OpenEXR's C library.
#pragma once

#include <cstdint>
#include <exception>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <openexr_context.h>

#include "image_io/exr_compression.h"
#include "image_io/exr_header.h"
#include "image_io/output_file.h"

namespace nacre {

// A single-part scanline file, with rows from the top down. To be used by one thread at a time.
class ExrContainer {
 public:
  // Opens the file and writes the header. Throws Error: kCannotWrite as OutputFile does, kInternal
  // for a header that OpenEXR refuses. If `memory` is not null, the file is written there instead.
  ExrContainer(const std::string& path, std::vector<uint8_t>* memory, const ExrHeader& header,
               Compression compression);
  ~ExrContainer();
  ExrContainer(const ExrContainer&) = delete;
  ExrContainer& operator=(const ExrContainer&) = delete;

  // Writes the next chunk, whose first row is `y`.
  void WriteChunk(int y, std::span<const uint8_t> bytes);

  // Changes the value of an attribute in the header, keeping its type, int or float.
  void UpdateAttribute(const std::string& name, const ExrAttribute& value);

  // To be called after the last chunk. Writes the chunk table and the checksum
  // (image_io/exr_checksum.h); then the file appears under its name.
  void Finish(bool sync);

 private:
  static int64_t OnWrite(exr_const_context_t context, void* user, const void* bytes, uint64_t size,
                         uint64_t offset, exr_stream_error_func_ptr_t error);
  void WriteHeader(const ExrHeader& header, Compression compression);
  void SetAttributes(const ExrHeader& header);
  void Write(uint64_t offset, std::span<const uint8_t> bytes);
  // Adds bytes of the chunk table or the chunks to the checksum.
  void Count(uint64_t offset, std::span<const uint8_t> bytes);
  void WriteChecksum();
  // The offset of an attribute's value in the file; 0 if there is none.
  size_t FindAttribute(const std::string& name, const std::string& type) const;
  // Throws unless `result` is success.
  void Check(exr_result_t result);

  std::string path_;
  std::vector<uint8_t>* memory_;    // where the bytes go; null:
  std::optional<OutputFile> file_;  // to this file
  exr_context_t context_ = nullptr;
  bool in_header_ = true;
  std::vector<uint8_t> header_;  // written at once, and kept for UpdateAttribute
  std::vector<uint8_t> table_;   // the chunk table, which is between header and chunks
  uint64_t chunks_begin_ = 0, chunks_end_ = 0;  // offsets in the file
  uint32_t chunks_crc_ = 0;
  std::exception_ptr write_exception_;  // carries an exception through the library's C functions
};

}  // namespace nacre
