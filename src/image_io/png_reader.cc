// SPDX-License-Identifier: Apache-2.0
// image_io/png_reader.cc: reads PNG files with libspng.
#include <array>
#include <cerrno>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <map>
#include <memory>
#include <new>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <spng.h>

#include "base/error.h"
#include "image_io/c_file.h"
#include "image_io/format_readers.h"
#include "image_io/icc_profile.h"
#include "image_io/orientation.h"

namespace nacre {
namespace {

constexpr uint32_t kLargestPngSide = 65536;
// Limits on the unpacked size of a text, a colour profile or the like, and on all of them together.
constexpr size_t kLargestChunk = size_t{1} << 24, kAllChunks = size_t{1} << 26;

// An open file, positioned at its first row. Any wrong checksum is an error.
class PngFile {
 public:
  explicit PngFile(const std::string& path)
      : path_(path), file_(OpenToRead(path)), png_(spng_ctx_new(0), &spng_ctx_free) {
    if (!file_) FailToRead(path, std::strerror(errno));
    if (!png_) throw std::bad_alloc();
    Check(spng_set_crc_action(get(), SPNG_CRC_ERROR, SPNG_CRC_ERROR));
    Check(spng_set_image_limits(get(), kLargestPngSide, kLargestPngSide));
    Check(spng_set_chunk_limits(get(), kLargestChunk, kAllChunks));
    Check(spng_set_option(get(), SPNG_KEEP_UNKNOWN_CHUNKS, 1));  // libspng does not know cICP
    Check(spng_set_png_file(get(), file_.get()));
    Check(spng_get_ihdr(get(), &header_));
    Check(spng_decode_chunks(get()));  // the chunks before the pixels
    spng_trns transparency{};
    has_alpha_ = (header_.color_type & 4) != 0 || spng_get_trns(get(), &transparency) == 0;
  }

  spng_ctx* get() const { return png_.get(); }
  const spng_ihdr& header() const { return header_; }
  bool is_color() const { return (header_.color_type & 2) != 0; }
  bool has_alpha() const { return has_alpha_; }
  size_t channels() const { return (is_color() ? 3 : 1) + (has_alpha_ ? 1 : 0); }
  bool is_wide() const { return header_.bit_depth == 16; }

  // Calls with_row(y, samples) for each row, from the first one on. Samples are codes of 8 bits or,
  // if is_wide(), of 16 bits in the processor's byte order.
  template <class WithRow>
  void ForEachRow(const WithRow& with_row) {
    if (!has_palette()) {
      ForEachDecodedRow(header_.width * channels() * (is_wide() ? 2 : 1), with_row);
      return;
    }
    spng_plte palette{};
    Check(spng_get_plte(get(), &palette));
    spng_trns transparency{};
    if (has_alpha_) Check(spng_get_trns(get(), &transparency));
    std::vector<uint8_t> colors(header_.width * channels());
    ForEachDecodedRow((size_t{header_.width} * header_.bit_depth + 7) / 8,
                      [&](uint32_t y, const uint8_t* indices) {
                        LookUp(y, indices, palette, transparency, colors.data());
                        with_row(y, colors.data());
                      });
  }

 private:
  bool has_palette() const { return header_.color_type == 3; }

  // Looks up the colours of a row, whose indices are packed into bytes from the high bits down.
  void LookUp(uint32_t y, const uint8_t* indices, const spng_plte& palette,
              const spng_trns& transparency, uint8_t* colors) const {
    const unsigned bits = header_.bit_depth;
    for (uint32_t x = 0; x < header_.width; ++x) {
      const size_t bit = size_t{x} * bits;
      const unsigned index = indices[bit / 8] >> (8 - bits - bit % 8) & ((1u << bits) - 1);
      if (index >= palette.n_entries) {
        throw Error(ExitCode::kBadInput, path_,
                    fmt::format("cannot be read: pixel ({}, {}) is colour {} of a palette that has "
                                "{}, counted from 0",
                                x, y, index, palette.n_entries),
                    "save it again without a palette, or with all colours in it");
      }
      const spng_plte_entry& color = palette.entries[index];
      *colors++ = color.red;
      *colors++ = color.green;
      *colors++ = color.blue;
      if (!has_alpha_) continue;
      const bool is_opaque = index >= transparency.n_type3_entries;
      *colors++ = is_opaque ? 255 : transparency.type3_alpha[index];
    }
  }

  // Decodes rows in the format of Format(), and then the chunks after them.
  template <class WithRow>
  void ForEachDecodedRow(size_t row_bytes, const WithRow& with_row) {
    const int flags = has_alpha_ && !has_palette() ? SPNG_DECODE_TRNS : 0;
    if (header_.interlace_method != 0) {
      std::vector<uint8_t> image(row_bytes * header_.height);
      Check(spng_decode_image(get(), image.data(), image.size(), Format(), flags));
      for (uint32_t y = 0; y < header_.height; ++y) with_row(y, image.data() + row_bytes * y);
    } else {
      std::vector<uint8_t> row(row_bytes);
      Check(spng_decode_image(get(), nullptr, 0, Format(), flags | SPNG_DECODE_PROGRESSIVE));
      for (uint32_t y = 0; y < header_.height; ++y) {
        const int status = spng_decode_row(get(), row.data(), row.size());
        if (status != SPNG_EOI || y + 1 < header_.height) Check(status);
        with_row(y, row.data());
      }
    }
    Check(spng_decode_chunks(get()));
    // libspng skips the checksum of the last chunk, IEND, so it is checked here.
    std::array<uint8_t, 4> end{};
    constexpr std::array<uint8_t, 4> kEnd = {0xae, 0x42, 0x60, 0x82};
    if (std::fseek(file_.get(), -4, SEEK_CUR) != 0 ||
        std::fread(end.data(), end.size(), 1, file_.get()) != 1 || end != kEnd) {
      FailToRead(path_, "the file ends too early");
    }
  }

  // The format that libspng unpacks to: one sample per channel, with alpha for a transparent
  // colour. Palette indices are kept, as libspng would replace indices beyond the palette by black.
  int Format() const {
    if (has_palette()) return SPNG_FMT_PNG;
    if (!is_color()) {
      if (!has_alpha_) return is_wide() ? SPNG_FMT_PNG : SPNG_FMT_G8;
      if ((header_.color_type & 4) != 0) return SPNG_FMT_PNG;
      return is_wide() ? SPNG_FMT_GA16 : SPNG_FMT_GA8;
    }
    if (has_alpha_) return is_wide() ? SPNG_FMT_RGBA16 : SPNG_FMT_RGBA8;
    return is_wide() ? SPNG_FMT_PNG : SPNG_FMT_RGB8;
  }

  void Check(int status) const {
    if (status == SPNG_EMEM) throw std::bad_alloc();
    if (status == SPNG_IO_EOF) FailToRead(path_, "the file ends too early");
    if (status == SPNG_EUSER_WIDTH || status == SPNG_EUSER_HEIGHT) {
      throw Error(ExitCode::kBadInput, path_,
                  fmt::format("cannot be read: it is {} than {} pixels",
                              status == SPNG_EUSER_WIDTH ? "wider" : "higher", kLargestPngSide),
                  "make it smaller");
    }
    if (status != 0) FailToRead(path_, spng_strerror(status));
  }

  std::string path_;
  CFile file_;
  std::unique_ptr<spng_ctx, decltype(&spng_ctx_free)> png_;
  spng_ihdr header_{};
  bool has_alpha_ = false;
};

using Metadata = std::map<std::string, std::string>;

void AddGamma(const PngFile& png, Metadata* metadata) {
  // libpng's PNG_GAMMA_THRESHOLD: smaller differences between exponents are invisible.
  constexpr double kGammaThreshold = 0.05;
  double encoding = 0;
  if (spng_get_gama(png.get(), &encoding) != 0 || !(encoding > 0)) return;
  const double gamma = 1 / encoding;
  (*metadata)["gamma"] = fmt::format("{:.6g}", gamma);
  if (std::abs(gamma / 2.2 - 1) > kGammaThreshold) {
    (*metadata)["not_srgb"] = fmt::format("a gamma of {:.4g} (gAMA)", gamma);
  }
}

void AddPrimaries(const PngFile& png, Metadata* metadata) {
  spng_chrm given{};
  if (spng_get_chrm(png.get(), &given) != 0) return;
  // White, red, green and blue of Rec. 709. The tolerance of 0.01 covers files that round to few
  // digits, and is invisible.
  constexpr double kRec709[] = {0.3127, 0.3290, 0.64, 0.33, 0.30, 0.60, 0.15, 0.06};
  constexpr double kNear = 0.01;
  const double values[] = {given.white_point_x, given.white_point_y, given.red_x,  given.red_y,
                           given.green_x,       given.green_y,       given.blue_x, given.blue_y};
  std::string text;
  bool near = true;
  for (size_t i = 0; i < 8; ++i) {
    text += fmt::format("{}{:.5g}", i == 0 ? "" : " ", values[i]);
    near = near && std::abs(values[i] - kRec709[i]) <= kNear;
  }
  (*metadata)["primaries"] = text;
  if (!near) (*metadata)["not_srgb"] = "primaries that are not sRGB's (cHRM)";
}

// The chunks for colours override each other in this order: gAMA and cHRM, sRGB, iCCP (W3C PNG,
// 4.3), cICP.
void AddProfile(const PngFile& png, Metadata* metadata) {
  uint8_t intent = 0;
  if (spng_get_srgb(png.get(), &intent) == 0) {
    (*metadata)["srgb_intent"] = std::to_string(intent);
    metadata->erase("not_srgb");
  }
  spng_iccp profile{};
  if (spng_get_iccp(png.get(), &profile) != 0) return;
  NoteIccProfile({reinterpret_cast<const uint8_t*>(profile.profile), profile.profile_len},
                 metadata);
}

// cICP overrides all others. By ITU-T H.273, primaries 1 are Rec. 709's, transfer 13 is sRGB's,
// matrix 0 and range 1 mean full-range RGB.
void AddCodePoints(const PngFile& png, Metadata* metadata) {
  uint32_t count = 0;
  if (spng_get_unknown_chunks(png.get(), nullptr, &count) != 0) return;
  std::vector<spng_unknown_chunk> chunks(count);
  if (spng_get_unknown_chunks(png.get(), chunks.data(), &count) != 0) return;
  for (const spng_unknown_chunk& chunk : chunks) {
    if (std::memcmp(chunk.type, "cICP", 4) != 0 || chunk.length != 4) continue;
    const auto* const points = static_cast<const uint8_t*>(chunk.data);
    const std::string text = fmt::format("{} {} {} {}", points[0], points[1], points[2], points[3]);
    (*metadata)["code_points"] = text;
    metadata->erase("not_srgb");
    if (text != "1 13 0 1") {
      (*metadata)["not_srgb"] = "the code points " + text + ", not 1 13 0 1 (cICP)";
    }
  }
}

std::string Utf8FromLatin1(std::string_view latin1) {
  std::string text;
  for (const char c : latin1) {
    const auto code = static_cast<unsigned char>(c);
    if (code < 0x80) {
      text += c;
    } else {
      text += static_cast<char>(0xc0 | code >> 6);
      text += static_cast<char>(0x80 | (code & 0x3f));
    }
  }
  return text;
}

// Texts of a file never replace the metadata that nacre derives from other chunks. The first of
// several texts with one keyword counts.
void AddTexts(const PngFile& png, Metadata* metadata) {
  uint32_t count = 0;
  if (spng_get_text(png.get(), nullptr, &count) != 0) return;
  std::vector<spng_text> texts(count);
  if (spng_get_text(png.get(), texts.data(), &count) != 0) return;
  for (const spng_text& text : texts) {
    const std::string keyword = Utf8FromLatin1(text.keyword);
    const std::string_view value(text.text, text.length);
    metadata->emplace(keyword.starts_with("nacre:") ? keyword : "png:" + keyword,
                      text.type == SPNG_ITXT ? std::string(value) : Utf8FromLatin1(value));
  }
}

Metadata MetadataOf(const PngFile& png) {
  Metadata metadata;
  AddGamma(png, &metadata);
  AddPrimaries(png, &metadata);
  AddProfile(png, &metadata);
  AddCodePoints(png, &metadata);
  AddTexts(png, &metadata);
  metadata["transfer"] = "display";
  return metadata;
}

Orientation OrientationOf(const PngFile& png) {
  spng_exif exif{};
  if (spng_get_exif(png.get(), &exif) != 0) return {};
  return OrientationOfTag(
      ExifOrientation({reinterpret_cast<const uint8_t*>(exif.data), exif.length}));
}

// Deflate makes at most 1032 bytes of one: a file that promises more would only cost memory.
void CheckPromise(const PngFile& png, const std::string& path, uint64_t file_bytes) {
  constexpr uint64_t kMaxRatio = 1032;
  const spng_ihdr& header = png.header();
  constexpr int kSamples[] = {1, 0, 3, 1, 2, 0, 4};
  const uint64_t bits = uint64_t{header.width} * header.bit_depth *
                        static_cast<uint64_t>(kSamples[header.color_type]);
  if ((bits / 8 + 1) * header.height / kMaxRatio > file_bytes) {
    FailToRead(path, fmt::format("{} bytes cannot hold its {} x {} pixels", file_bytes,
                                 header.width, header.height));
  }
}

template <typename Code>
void ToFloats(const uint8_t* codes, std::vector<float>* values) {
  constexpr auto kMost = static_cast<float>(static_cast<Code>(-1));
  for (size_t i = 0; i < values->size(); ++i) {
    Code code = 0;
    std::memcpy(&code, codes + i * sizeof(Code), sizeof(Code));
    (*values)[i] = static_cast<float>(code) / kMost;
  }
}

}  // namespace

ImageFile OpenPng(const std::string& path) {
  const PngFile png(path);
  CheckPromise(png, path, FileBytes(path));
  const Orientation orientation = OrientationOf(png);
  int width = static_cast<int>(png.header().width), height = static_cast<int>(png.header().height);
  if (orientation.transpose) std::swap(width, height);
  ImageFile image =
      MakeImageFile(path, width, height, png.is_color(), png.has_alpha(), MetadataOf(png));
  // Opens the file again for each reading, which decodes the rows from the first one on.
  image.read = [path, orientation, channels = png.channels(), data = image.header.data](
                   const Window& region, std::span<const SampleTarget> targets) {
    PngFile file(path);
    const RowPlacer placer(orientation, data, region, targets);
    CheckUnchanged(path, placer.stored_width() == static_cast<int>(file.header().width) &&
                             placer.stored_height() == static_cast<int>(file.header().height) &&
                             channels == file.channels());
    std::vector<float> values(file.header().width * channels);
    file.ForEachRow([&](uint32_t y, const uint8_t* codes) {
      file.is_wide() ? ToFloats<uint16_t>(codes, &values) : ToFloats<uint8_t>(codes, &values);
      placer.Place(static_cast<int>(y), values.data(), channels);
    });
  };
  return image;
}

}  // namespace nacre
