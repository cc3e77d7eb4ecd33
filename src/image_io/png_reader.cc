// SPDX-License-Identifier: Apache-2.0
#include "image_io/png_reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <memory>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <zlib.h>

#include "base/error.h"
#include "image_io/icc_profile.h"
#include "image_io/orientation.h"

namespace nacre {
namespace {

constexpr std::array<uint8_t, 8> kSignature = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
constexpr uint32_t kLargestSide = 65536;

uint32_t Big32(const uint8_t* bytes) {
  return uint32_t{bytes[0]} << 24 | uint32_t{bytes[1]} << 16 | uint32_t{bytes[2]} << 8 | bytes[3];
}

// Views into the file's bytes.
struct Png {
  std::vector<uint8_t> file;
  uint32_t width = 0, height = 0;
  uint8_t bits = 0, kind = 0;
  bool plain = false;                            // what OpenPlainPng reads
  std::span<const uint8_t> palette;              // r, g, b of each index
  std::vector<std::span<const uint8_t>> pixels;  // the IDAT chunks
  Orientation orientation;
  std::map<std::string, std::string> colors;  // as PngColors

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

bool ParseHeader(std::span<const uint8_t> data, Png* png) {
  if (data.size() != 13) return false;
  png->width = Big32(data.data());
  png->height = Big32(&data[4]);
  png->bits = data[8];
  png->kind = data[9];
  const bool known_kind =
      png->kind == 0 || png->kind == 2 || png->kind == 3 || png->kind == 4 || png->kind == 6;
  const bool known_bits = png->bits == 8 || (png->bits == 16 && png->kind != 3);
  const bool simple = data[10] == 0 && data[11] == 0 && data[12] == 0;
  png->plain = known_kind && known_bits && simple && png->width >= 1 && png->height >= 1 &&
               png->width <= kLargestSide && png->height <= kLargestSide;
  return true;
}

// EXIF's orientation tag (0x0112) in a block that begins as TIFF files do; 1 if there is none.
int ExifOrientation(std::span<const uint8_t> exif) {
  if (exif.size() < 8) return 1;
  const bool little = exif[0] == 'I';
  const auto number = [&](size_t at, size_t bytes) {
    size_t value = 0;
    for (size_t i = 0; i < bytes && at + bytes <= exif.size(); ++i) {
      value |= size_t{exif[at + i]} << 8 * (little ? i : bytes - 1 - i);
    }
    return value;
  };
  constexpr size_t kOrientation = 0x0112, kEntry = 12;
  const size_t first = number(4, 4);
  const size_t entries = number(first, 2);
  for (size_t i = 0; i < entries && first + 2 + (i + 1) * kEntry <= exif.size(); ++i) {
    const size_t at = first + 2 + i * kEntry;
    if (number(at, 2) == kOrientation) return static_cast<int>(number(at + 8, 2));
  }
  return 1;
}

// An iCCP chunk: a name, a method (deflate), the profile, which is looked at as far as it is short.
std::string ProfileName(std::span<const uint8_t> data) {
  const auto end = std::find(data.begin(), data.end(), 0);
  const std::string name(data.begin(), end);
  if (data.end() - end < 3) return name;
  const auto packed = data.subspan(static_cast<size_t>(end - data.begin()) + 2);
  constexpr uLongf kLongest = 1 << 20;
  std::vector<uint8_t> profile(kLongest);
  uLongf size = kLongest;
  if (uncompress(profile.data(), &size, packed.data(), packed.size()) != Z_OK) return name;
  return IsSrgbProfile(std::span(profile).first(size)) ? "sRGB" : name;
}

void ParseColors(std::string_view type, std::span<const uint8_t> data, Png* png) {
  constexpr double kUnit = 1e5;
  // libpng's PNG_GAMMA_THRESHOLD: exponents that differ less look the same.
  constexpr double kGammaThreshold = 0.05;
  if (type == "sRGB") png->colors["srgb_intent"] = std::to_string(data.empty() ? 0 : data[0]);
  if (type == "gAMA" && data.size() == 4 && Big32(data.data()) != 0) {
    const double gamma = kUnit / Big32(data.data());
    png->colors["gamma"] = fmt::format("{:.6g}", gamma);
    if (std::abs(gamma / 2.2 - 1) > kGammaThreshold) {
      png->colors["not_srgb"] = fmt::format("a gamma of {:.4g} (gAMA)", gamma);
    }
  }
  if (type == "cHRM" && data.size() == 32) {
    // White, red, green, blue of Rec. 709. A hundredth: what files with digits of 1/2 unit differ
    // by and what no eye sees.
    constexpr double kRec709[] = {0.3127, 0.3290, 0.64, 0.33, 0.30, 0.60, 0.15, 0.06};
    constexpr double kNear = 0.01;
    std::string text;
    bool near = true;
    for (size_t i = 0; i < 8; ++i) {
      const double value = Big32(&data[4 * i]) / kUnit;
      text += fmt::format("{}{:.5g}", i == 0 ? "" : " ", value);
      near = near && std::abs(value - kRec709[i]) <= kNear;
    }
    png->colors["primaries"] = text;
    if (!near) png->colors["not_srgb"] = "primaries that are not sRGB's (cHRM)";
  }
  if (type == "iCCP") png->colors["icc_profile"] = ProfileName(data);
}

// A chunk for colours is overruled by those that say more: sRGB, then iCCP (W3C PNG, 4.3).
void ResolveColors(Png* png) {
  const auto profile = png->colors.find("icc_profile");
  if (profile != png->colors.end()) {
    png->colors.erase("not_srgb");
    if (profile->second != "sRGB") {
      png->colors["not_srgb"] = "the ICC profile \"" + profile->second + "\"";
    }
  } else if (png->colors.contains("srgb_intent")) {
    png->colors.erase("not_srgb");
  }
}

// Takes what is before the next zero byte off the front of *data, and the zero byte.
std::string TakeWord(std::span<const uint8_t>* data) {
  const auto end = std::find(data->begin(), data->end(), 0);
  std::string word(data->begin(), end);
  *data = data->subspan(std::min(word.size() + 1, data->size()));
  return word;
}

// The beginning of a text that deflate made, as much of it as anybody reads: a few bytes of it may
// promise megabytes.
std::string InflateText(std::span<const uint8_t> data) {
  constexpr uLongf kLongest = 1 << 16;
  std::string text(kLongest, '\0');
  uLongf size = kLongest;
  const int status = uncompress(reinterpret_cast<Bytef*>(text.data()), &size, data.data(),
                                static_cast<uLong>(data.size()));
  if (status != Z_OK && status != Z_BUF_ERROR) return "(damaged)";
  text.resize(size);
  return text;
}

std::string Utf8FromLatin1(std::string_view latin1) {
  std::string utf8;
  for (const char c : latin1) {
    const auto code = static_cast<uint8_t>(c);
    if (code >= 0x80) utf8 += static_cast<char>(0xc0 | code >> 6);
    utf8 += static_cast<char>(code < 0x80 ? code : 0x80 | (code & 0x3f));
  }
  return utf8;
}

// tEXt: a keyword, a zero byte and text in Latin-1. zTXt: the text compressed, after its method.
// iTXt: whether and how it is compressed, the language, the keyword in it, and text in UTF-8 (W3C
// PNG, 11.3.3).
void ParseText(std::string_view type, std::span<const uint8_t> data, Png* png) {
  const std::string keyword = Utf8FromLatin1(TakeWord(&data));
  std::string text;
  if (type == "iTXt") {
    if (data.size() < 2) return;
    const bool compressed = data[0] == 1;
    data = data.subspan(2);
    TakeWord(&data);  // the language
    TakeWord(&data);  // the keyword in it
    text = compressed ? InflateText(data) : std::string(data.begin(), data.end());
  } else {
    if (type == "zTXt") data = data.subspan(std::min<size_t>(data.size(), 1));
    text =
        Utf8FromLatin1(type == "zTXt" ? InflateText(data) : std::string(data.begin(), data.end()));
  }
  // The first of several.
  png->colors.emplace(keyword.starts_with("nacre:") ? keyword : "png:" + keyword, text);
}

// False for broken files.
bool ParseChunks(Png* png) {
  const std::vector<uint8_t>& file = png->file;
  size_t at = kSignature.size();
  bool first = true;
  while (file.size() - at >= 12) {
    const size_t size = Big32(&file[at]);
    if (size > file.size() - at - 12) return false;
    const uint8_t* const type = &file[at + 4];
    const std::span<const uint8_t> data(type + 4, size);
    const uLong crc = crc32(0, type, static_cast<uInt>(size + 4));
    if (crc != Big32(type + 4 + size)) return false;
    const std::string_view name(reinterpret_cast<const char*>(type), 4);
    if (first != (name == "IHDR")) return false;
    if (first && !ParseHeader(data, png)) return false;
    first = false;
    if (name == "IEND") {
      ResolveColors(png);
      return true;
    }
    if (name == "tRNS") png->plain = false;
    if (name == "tEXt" || name == "zTXt" || name == "iTXt") ParseText(name, data, png);
    if (name == "PLTE") png->palette = data;
    if (name == "IDAT") png->pixels.push_back(data);
    if (name == "eXIf") png->orientation = OrientationOfTag(ExifOrientation(data));
    ParseColors(name, data, png);
    at += size + 12;
  }
  return false;
}

// Nothing for other and for broken files.
std::shared_ptr<const Png> ParsePng(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  std::array<uint8_t, kSignature.size()> signature{};
  stream.read(reinterpret_cast<char*>(signature.data()), signature.size());
  if (!stream || signature != kSignature) return {};
  stream.seekg(0, std::ios::end);
  const std::streamoff length = stream.tellg();
  constexpr std::streamoff kLongest = std::streamoff{1} << 32;
  if (length < static_cast<std::streamoff>(kSignature.size()) || length > kLongest) return {};
  auto png = std::make_shared<Png>();
  png->file.resize(static_cast<size_t>(length));
  stream.seekg(0);
  stream.read(reinterpret_cast<char*>(png->file.data()), length);
  if (!stream || !ParseChunks(png.get())) return {};
  return png;
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

// The file's rows, one after the other.
class PngRows {
 public:
  PngRows(const std::string& path, const Png& png)
      : path_(path), png_(png), above_(png.row_bytes() + 1), row_(png.row_bytes() + 1) {
    if (inflateInit(&stream_) != Z_OK) throw std::bad_alloc();
  }
  ~PngRows() { inflateEnd(&stream_); }
  PngRows(const PngRows&) = delete;
  PngRows& operator=(const PngRows&) = delete;

  // Valid until the next call.
  const uint8_t* Next() {
    std::swap(above_, row_);
    stream_.next_out = row_.data();
    stream_.avail_out = static_cast<uInt>(row_.size());
    while (stream_.avail_out > 0) Inflate();
    if (!Unfilter(row_[0], &above_[1], png_.pixel_bytes(), png_.row_bytes(), &row_[1])) Damaged();
    return &row_[1];
  }

  // After the last row: that the data end here, and their checksum.
  void Finish() {
    uint8_t more = 0;
    stream_.next_out = &more;
    stream_.avail_out = 1;
    while (!ended_) {
      Inflate();
      if (stream_.avail_out == 0) Damaged();
    }
  }

 private:
  [[noreturn]] void Damaged() const {
    throw Error(
        ExitCode::kBadInput, path_,
        "cannot be read: its compressed data are damaged, or not as many as its header says");
  }
  void Inflate() {
    if (ended_) Damaged();
    if (stream_.avail_in == 0) {
      if (next_ == png_.pixels.size()) Damaged();
      const std::span<const uint8_t> chunk = png_.pixels[next_++];
      stream_.next_in = const_cast<uint8_t*>(chunk.data());
      stream_.avail_in = static_cast<uInt>(chunk.size());
      if (chunk.empty()) return;
    }
    const int status = inflate(&stream_, Z_NO_FLUSH);
    if (status != Z_OK && status != Z_STREAM_END) Damaged();
    ended_ = status == Z_STREAM_END;
  }

  const std::string& path_;
  const Png& png_;
  std::vector<uint8_t> above_, row_;  // a byte of filter first
  z_stream stream_{};
  size_t next_ = 0;  // of the chunks
  bool ended_ = false;
};

void ReadPngPixels(const std::string& path, const Png& png, const Window& data,
                   const Window& region, std::span<const SampleTarget> targets) {
  const RowPlacer placer(png.orientation, data, region, targets);
  const float maximum = png.bits == 8 ? 255 : 65535;
  const size_t channels = png.kind == 3 ? 3 : png.channels();
  const size_t codes = png.width * png.channels();
  std::vector<float> values(png.width * channels);
  PngRows rows(path, png);
  for (uint32_t y = 0; y < png.height; ++y) {
    const uint8_t* const row = rows.Next();
    for (size_t i = 0; i < codes; ++i) {
      if (png.kind == 3) {
        const size_t entry = 3 * size_t{row[i]};
        if (entry + 3 > png.palette.size()) {
          throw Error(ExitCode::kBadInput, path, "cannot be read: a pixel is beyond its palette");
        }
        for (size_t c = 0; c < 3; ++c) {
          values[3 * i + c] = static_cast<float>(png.palette[entry + c]) / maximum;
        }
      } else {
        const int code = png.bits == 8 ? row[i] : row[2 * i] << 8 | row[2 * i + 1];
        values[i] = static_cast<float>(code) / maximum;
      }
    }
    placer.Place(static_cast<int>(y), values.data(), channels);
  }
  rows.Finish();
}

}  // namespace

std::map<std::string, std::string> PngColors(const std::string& path) {
  const auto png = ParsePng(path);
  return png ? png->colors : std::map<std::string, std::string>();
}

std::optional<ImageFile> OpenPlainPng(const std::string& path) {
  const auto png = ParsePng(path);
  if (!png || !png->plain) return {};
  // Deflate makes 1032 bytes of one at most: what promises more would only cost memory.
  constexpr uint64_t kMaxRatio = 1032;
  uint64_t compressed = 0;
  for (const auto& chunk : png->pixels) compressed += chunk.size();
  if ((png->row_bytes() + 1) * png->height / kMaxRatio > compressed) return {};
  ImageFile image;
  image.path = path;
  image.file_bytes = png->file.size();
  Image& header = image.header;
  int width = static_cast<int>(png->width), height = static_cast<int>(png->height);
  if (png->orientation.transpose) std::swap(width, height);
  header.data = header.display = {0, 0, width, height};
  header.metadata = png->colors;
  header.metadata["transfer"] = "display";
  const bool is_color = png->kind != 0 && png->kind != 4;
  std::vector<const char*> names = {"Y"};
  if (is_color) names = {"R", "G", "B"};
  if (png->kind == 4 || png->kind == 6) names.push_back("A");
  for (const char* name : names) header.channels.push_back({name, PixelType::kFloat, {}});
  image.parts = {PartOf(header)};
  image.read = [path, png, data = header.data](const Window& region,
                                               std::span<const SampleTarget> targets) {
    ReadPngPixels(path, *png, data, region, targets);
  };
  return image;
}

}  // namespace nacre
