// SPDX-License-Identifier: Apache-2.0
#include "image_io/exr_checksum.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <isa-l/crc.h>
#include <unistd.h>
#include <zlib.h>

namespace nacre {
namespace {

constexpr size_t kDigits = sizeof(kNoExrChecksum) - 1;

// The offset of the digits in the file; nullopt if the header has no such attribute. If the
// attribute has another type or length, 0, the offset of the magic number, where no valid digits
// can be.
std::optional<uint64_t> FindDigits(std::ifstream& file) {
  constexpr std::streamoff kFirstAttribute = 8;  // after the magic number and the version
  file.seekg(kFirstAttribute);
  std::string name, type;
  while (std::getline(file, name, '\0') && !name.empty() && std::getline(file, type, '\0')) {
    int32_t size = 0;
    if (!file.read(reinterpret_cast<char*>(&size), sizeof(size)) || size < 0) return std::nullopt;
    if (name == kExrChecksumAttribute) {
      const bool is_right = type == "string" && static_cast<size_t>(size) == kDigits;
      return is_right ? static_cast<uint64_t>(file.tellg()) : 0;
    }
    file.seekg(size, std::ios::cur);
  }
  return std::nullopt;
}

// Drops the file from the kernel's page cache, so that reading it reads the disk again.
void ForgetCachedPages(const std::string& path) {
  const int descriptor = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return;
  posix_fadvise(descriptor, 0, 0, POSIX_FADV_DONTNEED);
  close(descriptor);
}

}  // namespace

uint32_t Crc32(uint32_t crc, std::span<const uint8_t> bytes) {
  return crc32_gzip_refl(crc, bytes.data(), bytes.size());
}

uint32_t CombineCrc32(uint32_t crc, uint32_t next, uint64_t length) {
  return static_cast<uint32_t>(crc32_combine(crc, next, static_cast<z_off_t>(length)));
}

std::string ExrChecksumDigits(uint32_t crc) { return fmt::format("{:08x}", crc); }

ExrChecksum CheckExrChecksum(const std::string& path) {
  std::error_code error;
  // Kernel files that claim to be empty might block; they are refused later.
  if (!std::filesystem::is_regular_file(path, error) ||
      std::filesystem::file_size(path, error) == 0) {
    return ExrChecksum::kNone;
  }
  ForgetCachedPages(path);
  std::ifstream file(path, std::ios::binary);
  const std::optional<uint64_t> place = FindDigits(file);
  if (!file || !place) return ExrChecksum::kNone;
  file.seekg(static_cast<std::streamoff>(*place));
  std::string digits(kDigits, '\0');
  file.read(digits.data(), kDigits);
  file.seekg(0);
  uint32_t crc = 0;
  constexpr size_t kPiece = size_t{1} << 20;
  std::vector<uint8_t> piece(kPiece);
  for (uint64_t at = 0; file;) {
    file.read(reinterpret_cast<char*>(piece.data()), static_cast<std::streamsize>(kPiece));
    const auto got = static_cast<uint64_t>(file.gcount());
    for (size_t i = 0; i < kDigits; ++i) {
      if (*place + i >= at && *place + i < at + got) piece[*place + i - at] = '0';
    }
    crc = Crc32(crc, {piece.data(), got});
    at += got;
  }
  if (file.bad()) return ExrChecksum::kWrong;
  return digits == ExrChecksumDigits(crc) ? ExrChecksum::kRight : ExrChecksum::kWrong;
}

}  // namespace nacre
