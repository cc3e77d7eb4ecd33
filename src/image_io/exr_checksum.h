// SPDX-License-Identifier: Apache-2.0
// image_io/exr_checksum.h: the checksum in the header of every EXR file that nacre writes, by which
// a single flipped bit is noticed that no decoder would notice.
//
// The attribute nacre:checksum is a text of eight hexadecimal digits: the CRC-32 (zlib's, gzip's
// and PNG's) of all bytes of the file, its own digits taken as zeros. It depends on nothing but the
// file's content, so equal pictures still make equal files.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace nacre {

inline constexpr char kExrChecksumAttribute[] = "nacre:checksum";
// What stands in the attribute's place while the checksum is computed.
inline constexpr char kNoExrChecksum[] = "00000000";

// The CRC-32 of bytes that follow those of `crc`; 0 for the first.
uint32_t Crc32(uint32_t crc, std::span<const uint8_t> bytes);
// Of what `crc` is of and `length` bytes more, whose own is `next`.
uint32_t CombineCrc32(uint32_t crc, uint32_t next, uint64_t length);

std::string ExrChecksumDigits(uint32_t crc);

enum class ExrChecksum {
  kNone,   // the header has none that could be found: not nacre's, older than it, or damaged
  kRight,  // the file is what was written
  kWrong,  // it is not
};

// Reads all of the file, from its disk where the system has only a copy of that in memory. Files
// that cannot be read have no checksum.
ExrChecksum CheckExrChecksum(const std::string& path);

}  // namespace nacre
