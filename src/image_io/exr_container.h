// SPDX-License-Identifier: Apache-2.0
// image_io/exr_container.h: an EXR file around chunks that are compressed already.
// Uses OpenEXR's C library, as exr_chunk_check.cc does.
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

// A single-part scanline file with lines from the top down. One thread at a time.
class ExrContainer {
 public:
  // Opens the file and writes the header. Throws Error: kCannotWrite as OutputFile does,
  // kInternal for a header that OpenEXR refuses. With `memory` its bytes go there, and to no file.
  ExrContainer(const std::string& path, std::vector<uint8_t>* memory, const ExrHeader& header,
               Compression compression);
  ~ExrContainer();
  ExrContainer(const ExrContainer&) = delete;
  ExrContainer& operator=(const ExrContainer&) = delete;

  // The next chunk, whose first row is `y`.
  void WriteChunk(int y, std::span<const uint8_t> bytes);

  // Gives an attribute of the header another value of the same type, int or float.
  void UpdateAttribute(const std::string& name, const ExrAttribute& value);

  // After the last chunk: writes the table of chunks and the checksum (image_io/exr_checksum.h),
  // and the file appears.
  void Finish(bool sync);

 private:
  static int64_t OnWrite(exr_const_context_t context, void* user, const void* bytes, uint64_t size,
                         uint64_t offset, exr_stream_error_func_ptr_t error);
  void WriteHeader(const ExrHeader& header, Compression compression);
  void SetAttributes(const ExrHeader& header);
  void Write(uint64_t offset, std::span<const uint8_t> bytes);
  // Notes bytes of the table or the chunks for the checksum.
  void Count(uint64_t offset, std::span<const uint8_t> bytes);
  void WriteChecksum();
  // Where the value of an attribute stands in the file; 0 if there is none.
  size_t FindAttribute(const std::string& name, const std::string& type) const;
  // Throws unless `result` is success.
  void Check(exr_result_t result);

  std::string path_;
  std::vector<uint8_t>* memory_;    // where the bytes go, or null:
  std::optional<OutputFile> file_;  // they go there
  exr_context_t context_ = nullptr;
  bool in_header_ = true;
  std::vector<uint8_t> header_;  // its bytes, written at once, kept for UpdateAttribute
  std::vector<uint8_t> table_;   // the offsets of chunks, which stand between header and chunks
  uint64_t chunks_begin_ = 0, chunks_end_ = 0;  // in the file
  uint32_t chunks_crc_ = 0;
  std::exception_ptr write_exception_;  // carried across the library's C frames
};

}  // namespace nacre
