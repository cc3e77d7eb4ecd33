// SPDX-License-Identifier: Apache-2.0
// tests/image_io/png_reader_test.cc: every kind of PNG file, and damaged ones.
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "catch.h"
#include "files.h"
#include "image_io/format_readers.h"
#include "image_io/read_image.h"
#include "pictures.h"
#include "png_bytes.h"

namespace nacre {
namespace {

// 1, 2, 4, 8 or 16 bits a sample: W3C PNG, 11.2.2.
struct Kind {
  int color_type, bits;
  int samples() const {
    return color_type == 2 ? 3 : color_type == 4 ? 2 : color_type == 6 ? 4 : 1;
  }
};
constexpr Kind kKinds[] = {{0, 1}, {0, 2}, {0, 4}, {0, 8}, {0, 16}, {2, 8}, {2, 16}, {3, 1},
                           {3, 2}, {3, 4}, {3, 8}, {4, 8}, {4, 16}, {6, 8}, {6, 16}};

// Not a multiple of anything, and with every pass of Adam7.
constexpr uint32_t kPngWidth = 13, kPngHeight = 11;

using Codes = std::vector<unsigned>;  // of all samples, row by row

const unsigned& CodeAt(const Codes& codes, const Kind& kind, uint32_t x, uint32_t y, int c) {
  return codes[(y * kPngWidth + x) * static_cast<size_t>(kind.samples()) + static_cast<size_t>(c)];
}

// Every step_x-th pixel of every step_y-th row, from (x0, y0) on: rows of bits, unfiltered.
void AppendRows(const Codes& codes, const Kind& kind, const uint32_t (&pass)[4],
                std::vector<uint8_t>* rows) {
  if (pass[0] >= kPngWidth) return;
  for (uint32_t y = pass[1]; y < kPngHeight; y += pass[3]) {
    rows->push_back(0);
    unsigned byte = 0;
    int filled = 0;
    const auto put = [&](unsigned code, int bits) {
      for (int bit = bits - 1; bit >= 0; --bit) {
        byte = byte << 1 | (code >> bit & 1);
        if (++filled < 8) continue;
        rows->push_back(static_cast<uint8_t>(byte));
        byte = 0;
        filled = 0;
      }
    };
    for (uint32_t x = pass[0]; x < kPngWidth; x += pass[2]) {
      for (int c = 0; c < kind.samples(); ++c) put(CodeAt(codes, kind, x, y, c), kind.bits);
    }
    if (filled > 0) put(0, 8 - filled);
  }
}

std::vector<uint8_t> RowsOf(const Codes& codes, const Kind& kind, bool interlaced) {
  // Adam7, W3C PNG, 8.2: x0, y0, step_x, step_y.
  constexpr uint32_t kPasses[7][4] = {{0, 0, 8, 8}, {4, 0, 8, 8}, {0, 4, 4, 8}, {2, 0, 4, 4},
                                      {0, 2, 2, 4}, {1, 0, 2, 2}, {0, 1, 1, 2}};
  constexpr uint32_t kWhole[4] = {0, 0, 1, 1};
  std::vector<uint8_t> rows;
  if (!interlaced) AppendRows(codes, kind, kWhole, &rows);
  for (const auto& pass : kPasses) {
    if (interlaced) AppendRows(codes, kind, pass, &rows);
  }
  return rows;
}

std::vector<uint8_t> Big16(const std::vector<unsigned>& values) {
  std::vector<uint8_t> bytes;
  for (const unsigned value : values) {
    bytes.push_back(static_cast<uint8_t>(value >> 8));
    bytes.push_back(static_cast<uint8_t>(value));
  }
  return bytes;
}

struct Written {
  std::vector<uint8_t> file;
  Codes codes;
  std::vector<uint8_t> palette, palette_alpha;
  bool transparent;
};

// With random pixels; `transparent`: a tRNS chunk that some of them have to do with.
Written Write(const Kind& kind, bool interlaced, bool transparent, unsigned seed) {
  std::mt19937 random(seed);
  Written png{PngHead(kPngWidth, kPngHeight, kind.bits, kind.color_type, interlaced),
              {},
              {},
              {},
              transparent};
  png.codes.resize(size_t{kPngWidth} * kPngHeight * static_cast<size_t>(kind.samples()));
  for (unsigned& code : png.codes) code = static_cast<unsigned>(random() % (1u << kind.bits));
  if (kind.color_type == 3) {
    for (int i = 0; i < 3 << kind.bits; ++i) png.palette.push_back(static_cast<uint8_t>(random()));
    AppendChunk("PLTE", png.palette, &png.file);
    // Fewer than the palette has: the rest is opaque.
    for (int i = 0; i < 1 << (kind.bits - 1); ++i) {
      png.palette_alpha.push_back(static_cast<uint8_t>(random()));
    }
    if (transparent) AppendChunk("tRNS", png.palette_alpha, &png.file);
  } else if (transparent) {
    // The colour of pixel (5, 5) stands for nothing.
    std::vector<unsigned> color;
    for (int c = 0; c < kind.samples(); ++c) color.push_back(CodeAt(png.codes, kind, 5, 5, c));
    AppendChunk("tRNS", Big16(color), &png.file);
  }
  AppendPixels(RowsOf(png.codes, kind, interlaced), &png.file);
  return png;
}

// What the standard says the samples of a pixel are.
std::vector<double> Expected(const Written& png, const Kind& kind, uint32_t x, uint32_t y) {
  std::vector<double> values;
  if (kind.color_type == 3) {
    const unsigned index = CodeAt(png.codes, kind, x, y, 0);
    for (unsigned c = 0; c < 3; ++c) values.push_back(png.palette[3 * index + c] / 255.0);
    const bool has_alpha = index < png.palette_alpha.size();
    if (png.transparent) values.push_back(has_alpha ? png.palette_alpha[index] / 255.0 : 1);
    return values;
  }
  bool is_keyed = true;
  for (int c = 0; c < kind.samples(); ++c) {
    const unsigned code = CodeAt(png.codes, kind, x, y, c);
    values.push_back(code / static_cast<double>((1u << kind.bits) - 1));
    is_keyed = is_keyed && code == CodeAt(png.codes, kind, 5, 5, c);
  }
  if (png.transparent) values.push_back(is_keyed ? 0 : 1);
  return values;
}

TEST_CASE("PNG files of every kind are read") {
  const TestFolder folder;
  const std::string path = folder / "a.png";
  unsigned seed = 0;
  for (const Kind& kind : kKinds) {
    for (const bool interlaced : {false, true}) {
      for (const bool transparent : {false, true}) {
        if (transparent && (kind.color_type & 4) != 0) continue;
        CAPTURE(kind.color_type, kind.bits, interlaced, transparent);
        const Written png = Write(kind, interlaced, transparent, ++seed);
        WriteBytes(path, png.file);
        const Image image = ReadImage(path);
        REQUIRE(image.data == Window{0, 0, kPngWidth, kPngHeight});
        const size_t channels = Expected(png, kind, 0, 0).size();
        REQUIRE(image.channels.size() == channels);
        CHECK(image.channels[0].name == (channels < 3 ? "Y" : "R"));
        CHECK((image.channels.back().name == "A") == (channels % 2 == 0));
        for (uint32_t y = 0; y < kPngHeight; ++y) {
          for (uint32_t x = 0; x < kPngWidth; ++x) {
            const std::vector<double> expected = Expected(png, kind, x, y);
            for (size_t c = 0; c < channels; ++c) {
              CAPTURE(x, y, c);
              // A quotient of floats, rounded once.
              REQUIRE(std::abs(image.channels[c].samples[y * kPngWidth + x] - expected[c]) <= 6e-8);
            }
          }
        }
      }
    }
  }
}

TEST_CASE("PNG files whose pixels are beyond their palettes are refused") {
  const TestFolder folder;
  const std::string path = folder / "a.png";
  for (const int bits : {1, 2, 4, 8}) {
    for (const bool interlaced : {false, true}) {
      CAPTURE(bits, interlaced);
      const auto colors = static_cast<size_t>(bits == 8 ? 16 : (1 << bits) - 1);
      const auto write = [&](const std::vector<unsigned>& row) {
        std::vector<uint8_t> file = PngHead(kPngWidth, kPngHeight, bits, 3, interlaced);
        AppendChunk("PLTE", std::vector<uint8_t>(3 * colors, 200), &file);
        Codes codes(size_t{kPngWidth} * kPngHeight);
        for (size_t x = 0; x < row.size(); ++x) codes[4 * kPngWidth + x] = row[x];
        AppendPixels(RowsOf(codes, {3, bits}, interlaced), &file);
        WriteBytes(path, file);
        return Catching([&] { ReadImage(path); });
      };
      const auto most = static_cast<unsigned>(colors) - 1;
      CHECK(write({0, 0, most}).code == ExitCode::kOk);
      const Caught beyond = write({0, 0, most, most + 1});
      CHECK(beyond.code == ExitCode::kBadInput);
      CAPTURE(beyond.message);
      CHECK(beyond.Says("a.png: cannot be read: pixel (3, 4) is colour " + std::to_string(colors) +
                        " of a palette that has " + std::to_string(colors)));
      CHECK(beyond.Says("hint: save it again"));
    }
  }
}

// As libpng reads them: libspng, which reads no further than the last row needs, does not tell.
TEST_CASE("what a PNG has behind its last row changes nothing") {
  const TestFolder folder;
  for (const size_t more : {0, 300}) {
    std::vector<uint8_t> file = PngHead(2, 1, 8, 0);
    std::vector<uint8_t> rows = {0, 51, 255};
    rows.resize(rows.size() + more);
    AppendPixels(rows, &file);
    WriteBytes(folder / "a.png", file);
    CHECK(ReadImage(folder / "a.png").channels[0].samples == std::vector<float>{0.2f, 1});
  }
}

TEST_CASE("texts of PNG files are metadata, but not in the place of facts") {
  const TestFolder folder;
  std::vector<uint8_t> file = PngHead(1, 1, 8, 0);
  const auto text = [&](const std::string& chunk, const std::string& bytes) {
    AppendChunk(chunk, {bytes.begin(), bytes.end()}, &file);
  };
  using std::string_literals::operator""s;
  text("tEXt", "Author\0J\xfcrgen"s);
  text("iTXt", "Title\0\0\0de\0Titel\0K\xc3\xbcgelchen"s);
  text("tEXt", "Author\0again"s);
  text("tEXt", "nacre:scene\0ball"s);
  text("tEXt", "transfer\0linear"s);
  text("tEXt", "not_srgb\0a lie"s);
  AppendPixels({0, 128}, &file);
  WriteBytes(folder / "a.png", file);
  const Image image = ReadImage(folder / "a.png");
  CHECK(image.metadata.at("png:Author") == "J\xc3\xbcrgen");
  CHECK(image.metadata.at("png:Title") == "K\xc3\xbcgelchen");
  CHECK(image.metadata.at("png:transfer") == "linear");
  CHECK(image.metadata.at("transfer") == "display");
  CHECK(image.metadata.at("nacre:scene") == "ball");
  CHECK_FALSE(image.metadata.contains("not_srgb"));
}

TEST_CASE("damaged PNG files are refused, wherever the damage is") {
  const TestFolder folder;
  const std::string path = folder / "a.png";
  const std::vector<uint8_t> good = ReadBytes(NACRE_SOURCE_DIR "/scenes/textures/tiles.png");
  const auto reads = [&](const std::vector<uint8_t>& bytes) {
    WriteBytes(path, bytes);
    const Caught caught = Catching([&] { ReadImage(path); });
    if (caught.code == ExitCode::kOk) return true;
    CHECK(caught.code == ExitCode::kBadInput);
    CHECK(caught.Says("a.png"));
    return false;
  };
  REQUIRE(reads(good));
  // Cut off anywhere, and one bit of any byte changed: the checksums tell.
  for (size_t i = 0; i < good.size(); i += 7) {
    CAPTURE(i);
    CHECK_FALSE(reads({good.begin(), good.begin() + static_cast<ptrdiff_t>(i)}));
    std::vector<uint8_t> changed = good;
    changed[i] = static_cast<uint8_t>(changed[i] ^ 4);
    CHECK_FALSE(reads(changed));
  }
}

}  // namespace
}  // namespace nacre
