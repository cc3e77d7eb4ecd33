// SPDX-License-Identifier: Apache-2.0
#include "image_io/png_reader.h"

#include <array>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <vector>

#include <zlib.h>

namespace nacre {
namespace {

constexpr std::array<uint8_t, 8> kSignature = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
constexpr uint32_t kLargestSide = 65536;

uint32_t Big32(const uint8_t* bytes) {
  return uint32_t{bytes[0]} << 24 | uint32_t{bytes[1]} << 16 | uint32_t{bytes[2]} << 8 | bytes[3];
}

struct Png {
  uint32_t width = 0, height = 0;
  uint8_t bits = 0, kind = 0;
  std::vector<uint8_t> palette;     // r, g, b of each index
  std::vector<uint8_t> compressed;  // all IDAT chunks

  // Samples of a pixel in the file.
  size_t channels() const {
    switch (kind) {
      case 2:
        return 3;
      case 4:
        return 2;
      case 6:
        return 4;
      default:
        return 1;
    }
  }
  size_t pixel_bytes() const { return channels() * bits / 8; }
  size_t row_bytes() const { return size_t{width} * pixel_bytes(); }
};

bool ParseHeader(const uint8_t* data, size_t size, Png* png) {
  if (size != 13) return false;
  png->width = Big32(data);
  png->height = Big32(data + 4);
  png->bits = data[8];
  png->kind = data[9];
  const bool known_kind =
      png->kind == 0 || png->kind == 2 || png->kind == 3 || png->kind == 4 || png->kind == 6;
  const bool known_bits = png->bits == 8 || (png->bits == 16 && png->kind != 3);
  const bool plain = data[10] == 0 && data[11] == 0 && data[12] == 0;
  return known_kind && known_bits && plain && png->width >= 1 && png->height >= 1 &&
         png->width <= kLargestSide && png->height <= kLargestSide;
}

// False for what a plain file does not have, and for what is broken.
bool ParseChunks(const std::vector<uint8_t>& file, Png* png) {
  size_t at = kSignature.size();
  bool first = true;
  while (file.size() - at >= 12) {
    const size_t size = Big32(&file[at]);
    if (size > file.size() - at - 12) return false;
    const uint8_t* const type = &file[at + 4];
    const uint8_t* const data = type + 4;
    const uLong crc = crc32(0, type, static_cast<uInt>(size + 4));
    if (crc != Big32(data + size)) return false;
    const auto is = [&](const char* name) { return std::memcmp(type, name, 4) == 0; };
    if (first != is("IHDR")) return false;
    if (first && !ParseHeader(data, size, png)) return false;
    first = false;
    if (is("IEND")) return true;
    if (is("tRNS")) return false;
    if (is("PLTE")) png->palette.assign(data, data + size);
    if (is("IDAT")) png->compressed.insert(png->compressed.end(), data, data + size);
    at += size + 12;
  }
  return false;
}

// The predictor of PNG's filter 4 (W3C PNG, 9.4).
int Paeth(int left, int up, int up_left) {
  const int estimate = left + up - up_left;
  const int d_left = std::abs(estimate - left), d_up = std::abs(estimate - up);
  const int d_up_left = std::abs(estimate - up_left);
  if (d_left <= d_up && d_left <= d_up_left) return left;
  return d_up <= d_up_left ? up : up_left;
}

// Undoes a row's filter. `above`: the row before, zeros for the first one.
bool Unfilter(int filter, const uint8_t* above, size_t step, size_t size, uint8_t* row) {
  if (filter > 4) return false;
  for (size_t i = 0; i < size; ++i) {
    const int left = i >= step ? row[i - step] : 0;
    const int up = above[i];
    const int up_left = i >= step ? above[i - step] : 0;
    int prediction = 0;
    if (filter == 1) prediction = left;
    if (filter == 2) prediction = up;
    if (filter == 3) prediction = (left + up) / 2;
    if (filter == 4) prediction = Paeth(left, up, up_left);
    row[i] = static_cast<uint8_t>(row[i] + prediction);
  }
  return true;
}

// The file's samples, row by row, a byte of filter before each row.
bool Decompress(const Png& png, std::vector<uint8_t>* rows) {
  const size_t stride = png.row_bytes() + 1;
  // Deflate makes 1032 bytes of one at most: what promises more would only cost memory.
  constexpr size_t kMaxRatio = 1032;
  if (stride * png.height / kMaxRatio > png.compressed.size()) return false;
  rows->resize(stride * png.height);
  uLongf size = rows->size();
  const int status = uncompress(rows->data(), &size, png.compressed.data(), png.compressed.size());
  if (status != Z_OK || size != rows->size()) return false;
  const std::vector<uint8_t> zeros(png.row_bytes());
  const uint8_t* above = zeros.data();
  for (size_t y = 0; y < png.height; ++y) {
    uint8_t* const row = rows->data() + y * stride;
    if (!Unfilter(row[0], above, png.pixel_bytes(), png.row_bytes(), row + 1)) return false;
    above = row + 1;
  }
  return true;
}

bool FillChannels(const Png& png, const std::vector<uint8_t>& rows, Image* image) {
  const size_t stride = png.row_bytes() + 1, sample_bytes = png.bits / 8;
  const float maximum = png.bits == 8 ? 255 : 65535;
  size_t out = 0;
  for (size_t y = 0; y < png.height; ++y) {
    const uint8_t* at = rows.data() + y * stride + 1;
    for (size_t x = 0; x < png.width; ++x, ++out) {
      if (png.kind == 3) {
        const size_t entry = 3 * size_t{*at++};
        if (entry + 3 > png.palette.size()) return false;
        for (size_t c = 0; c < 3; ++c) {
          image->channels[c].samples[out] = static_cast<float>(png.palette[entry + c]) / maximum;
        }
        continue;
      }
      for (Channel& channel : image->channels) {
        const int code = sample_bytes == 1 ? at[0] : at[0] << 8 | at[1];
        channel.samples[out] = static_cast<float>(code) / maximum;
        at += sample_bytes;
      }
    }
  }
  return true;
}

}  // namespace

std::optional<Image> ReadPlainPng(const std::string& path, uint64_t max_samples) {
  std::ifstream stream(path, std::ios::binary);
  std::array<uint8_t, kSignature.size()> signature{};
  stream.read(reinterpret_cast<char*>(signature.data()), signature.size());
  if (!stream || signature != kSignature) return {};
  stream.seekg(0, std::ios::end);
  const std::streamoff length = stream.tellg();
  constexpr std::streamoff kLongest = std::streamoff{1} << 31;  // chunks have 31 bits for theirs
  if (length < static_cast<std::streamoff>(kSignature.size()) || length > kLongest) return {};
  std::vector<uint8_t> file(static_cast<size_t>(length));
  stream.seekg(0);
  stream.read(reinterpret_cast<char*>(file.data()), static_cast<std::streamsize>(file.size()));
  Png png;
  if (!stream || !ParseChunks(file, &png)) return {};
  const bool is_color = png.kind != 0 && png.kind != 4;
  std::vector<const char*> names = {"Y"};
  if (is_color) names = {"R", "G", "B"};
  if (png.kind == 4 || png.kind == 6) names.push_back("A");
  const uint64_t pixels = uint64_t{png.width} * png.height;
  if (pixels * names.size() > max_samples) return {};
  std::vector<uint8_t> rows;
  if (!Decompress(png, &rows)) return {};
  Image image;
  image.data = image.display = {0, 0, static_cast<int>(png.width), static_cast<int>(png.height)};
  image.metadata["transfer"] = "display";
  for (const char* name : names) {
    image.channels.push_back({name, PixelType::kFloat, std::vector<float>(pixels)});
  }
  if (!FillChannels(png, rows, &image)) return {};
  return image;
}

}  // namespace nacre
