// SPDX-License-Identifier: Apache-2.0
// tests/image_io/png_bytes.h: PNG files put together chunk by chunk, by the letter of the standard
// (W3C PNG) and without a library for it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <zlib.h>

namespace nacre {

inline std::vector<uint8_t> Big32(uint64_t value) {
  return {static_cast<uint8_t>(value >> 24), static_cast<uint8_t>(value >> 16),
          static_cast<uint8_t>(value >> 8), static_cast<uint8_t>(value)};
}

inline void AppendChunk(const std::string& name, const std::vector<uint8_t>& data,
                        std::vector<uint8_t>* file) {
  std::vector<uint8_t> body(name.begin(), name.end());
  body.insert(body.end(), data.begin(), data.end());
  const std::vector<uint8_t> size = Big32(data.size());
  const std::vector<uint8_t> crc = Big32(crc32(0, body.data(), static_cast<uInt>(body.size())));
  for (const std::vector<uint8_t>& part : {size, body, crc}) {
    file->insert(file->end(), part.begin(), part.end());
  }
}

// The signature and the header. `kind`: the colour type.
inline std::vector<uint8_t> PngHead(uint32_t width, uint32_t height, int bits, int kind,
                                    bool interlaced = false) {
  std::vector<uint8_t> file = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  std::vector<uint8_t> header = Big32(width);
  const std::vector<uint8_t> rows = Big32(height);
  header.insert(header.end(), rows.begin(), rows.end());
  for (const int byte : {bits, kind, 0, 0, interlaced ? 1 : 0}) {
    header.push_back(static_cast<uint8_t>(byte));
  }
  AppendChunk("IHDR", header, &file);
  return file;
}

// The pixels, rows with their filters' bytes, and the end.
inline void AppendPixels(const std::vector<uint8_t>& rows, std::vector<uint8_t>* file) {
  std::vector<uint8_t> data(compressBound(rows.size()));
  uLongf size = data.size();
  compress2(data.data(), &size, rows.data(), rows.size(), 9);
  data.resize(size);
  AppendChunk("IDAT", data, file);
  AppendChunk("IEND", {}, file);
}

}  // namespace nacre
