// SPDX-License-Identifier: Apache-2.0
// image_io/exr_checksum.h: the checksum in the header of every EXR file that nacre writes. It
// reveals a single flipped bit that no decoder would notice.
//
// The attribute nacre:checksum is a string of eight hexadecimal digits: the CRC-32 (of zlib, gzip
// and PNG) of all bytes of the file, with these digits replaced by zeros. It depends on nothing but
// the file's content, so equal pictures still make equal files.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace nacre {

inline constexpr char kExrChecksumAttribute[] = "nacre:checksum";
// The value of the attribute while the checksum is computed.
inline constexpr char kNoExrChecksum[] = "00000000";

// Extends the CRC-32 `crc` of earlier bytes, 0 at first, by `bytes`.
uint32_t Crc32(uint32_t crc, std::span<const uint8_t> bytes);
// The CRC-32 of bytes whose checksum is `crc`, followed by `length` bytes whose checksum is `next`.
uint32_t CombineCrc32(uint32_t crc, uint32_t next, uint64_t length);

std::string ExrChecksumDigits(uint32_t crc);

enum class ExrChecksum {
  kNone,   // the header has no valid one: not written by nacre, by an older nacre, or damaged
  kRight,  // the file is unchanged since it was written
  kWrong,  // the file has changed
};

// Reads the whole file, from disk if the system has only cached it in memory. A file that cannot be
// read gives kNone.
ExrChecksum CheckExrChecksum(const std::string& path);

}  // namespace nacre
