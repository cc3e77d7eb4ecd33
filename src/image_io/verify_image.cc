// SPDX-License-Identifier: Apache-2.0
#include "image_io/verify_image.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <span>
#include <vector>

#include <zlib.h>

#include "base/error.h"
#include "base/path.h"
#include "image_io/exr_bands.h"
#include "image_io/exr_checksum.h"
#include "image_io/image_file.h"

namespace nacre {
namespace {

[[noreturn]] void RefuseDamaged(const std::string& path, const std::string& what) {
  throw Error(ExitCode::kBadInput, path, "is damaged: " + what, "make it again");
}

std::string VerifyExr(const std::string& path) {
  const ExrChecksum checksum = CheckExrChecksum(path);
  if (checksum == ExrChecksum::kWrong) {
    RefuseDamaged(path, "its bytes are not those that its checksum was made of");
  }
  if (checksum == ExrChecksum::kRight) {  // nacre's own, of any size
    ExrBandReader(path).DecodeAll();
    return "whole: its checksum is right, and every sample decodes";
  }
  ReadImage(path);
  return "every sample decodes; it has no checksum of nacre's";
}

constexpr std::array<uint8_t, 8> kPngSignature = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};

uint32_t ReadBig32(const uint8_t* bytes) {
  return uint32_t{bytes[0]} << 24 | uint32_t{bytes[1]} << 16 | uint32_t{bytes[2]} << 8 | bytes[3];
}

// The pixels' zlib stream, which comes in pieces: inflated to see that it ends, with the checksum
// that it should have. What comes out is counted and dropped.
class PixelStream {
 public:
  explicit PixelStream(const std::string& path) : path_(path) {
    if (inflateInit(&stream_) != Z_OK) throw std::bad_alloc();
  }
  ~PixelStream() { inflateEnd(&stream_); }
  PixelStream(const PixelStream&) = delete;
  PixelStream& operator=(const PixelStream&) = delete;

  void Add(std::span<const uint8_t> bytes) {
    stream_.next_in = const_cast<uint8_t*>(bytes.data());  // only read
    stream_.avail_in = static_cast<uInt>(bytes.size());
    while (stream_.avail_in > 0 && !ended_) {
      stream_.next_out = out_.data();
      stream_.avail_out = static_cast<uInt>(out_.size());
      const int result = inflate(&stream_, Z_NO_FLUSH);
      if (result != Z_OK && result != Z_STREAM_END) {
        RefuseDamaged(path_, "its pixels cannot be decompressed");
      }
      count_ += out_.size() - stream_.avail_out;
      ended_ = result == Z_STREAM_END;
    }
  }
  bool ended() const { return ended_; }
  uint64_t count() const { return count_; }

 private:
  const std::string& path_;
  z_stream stream_{};
  std::array<uint8_t, 65536> out_{};
  uint64_t count_ = 0;
  bool ended_ = false;
};

// Bytes of the pixels before compression; 0 for interlaced pictures, whose passes are not counted
// here.
uint64_t PngPixelBytes(const std::vector<uint8_t>& header) {
  const uint64_t width = ReadBig32(&header[0]), height = ReadBig32(&header[4]);
  constexpr std::array<uint64_t, 7> kChannels = {1, 0, 3, 1, 2, 0, 4};
  const uint8_t kind = header[9];
  if (header[12] != 0 || kind >= kChannels.size()) return 0;
  return height * (1 + (width * kChannels[kind] * header[8] + 7) / 8);
}

std::string VerifyPng(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  file.seekg(kPngSignature.size());
  PixelStream pixels(path);
  uint64_t pixel_bytes = 0;
  std::vector<uint8_t> chunk;
  std::array<uint8_t, 8> start{};  // length and type
  constexpr size_t kHeaderBytes = 13;
  constexpr uint32_t kLongest = uint32_t{1} << 31;
  const auto left = static_cast<uint64_t>(std::filesystem::file_size(path));
  while (file.read(reinterpret_cast<char*>(start.data()), start.size())) {
    const uint32_t size = ReadBig32(start.data());
    if (size >= kLongest || size > left) break;
    chunk.resize(size_t{size} + 4);  // and the checksum
    if (!file.read(reinterpret_cast<char*>(chunk.data()),
                   static_cast<std::streamsize>(chunk.size())))
      break;
    const std::span<const uint8_t> type(start.data() + 4, 4), data(chunk.data(), size);
    if (Crc32(Crc32(0, type), data) != ReadBig32(&chunk[size])) {
      RefuseDamaged(path, "a chunk's checksum is wrong");
    }
    const auto is = [&](const char* name) { return std::memcmp(type.data(), name, 4) == 0; };
    if (is("IHDR") && size == kHeaderBytes) pixel_bytes = PngPixelBytes(chunk);
    if (is("IDAT")) pixels.Add(data);
    if (!is("IEND")) continue;
    const bool is_complete = pixels.ended() &&
                             (pixel_bytes == 0 || pixels.count() == pixel_bytes) &&
                             file.peek() == std::ifstream::traits_type::eof();
    if (!is_complete) RefuseDamaged(path, "it does not hold all of its pixels and nothing else");
    return "whole: all checksums are right, and every pixel is there";
  }
  RefuseDamaged(path, "it ends too early");
}

}  // namespace

std::string VerifyImage(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) {
    throw Error(ExitCode::kBadInput, path, error ? error.message() : "is not a regular file");
  }
  if (HasExtension(path, ".exr")) return VerifyExr(path);
  std::array<uint8_t, kPngSignature.size()> first{};
  std::ifstream(path, std::ios::binary).read(reinterpret_cast<char*>(first.data()), first.size());
  if (first == kPngSignature) return VerifyPng(path);
  ReadImage(path);
  return "every sample decodes; files of its kind have no checksum";
}

}  // namespace nacre
