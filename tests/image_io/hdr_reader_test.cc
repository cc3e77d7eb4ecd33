// SPDX-License-Identifier: Apache-2.0
// tests/image_io/hdr_reader_test.cc: Radiance files against Ward's formulas.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include <unistd.h>

#include "base/error.h"
#include "catch.h"
#include "image_io/format_readers.h"
#include "image_io/read_image.h"

namespace nacre {
namespace {

// Removed when it goes.
struct HdrFile {
  std::string path;

  explicit HdrFile(const std::string& bytes)
      : path(std::filesystem::temp_directory_path() /
             ("nacre_hdr_test_" + std::to_string(getpid()) + ".hdr")) {
    std::ofstream(path, std::ios::binary) << bytes;
  }
  ~HdrFile() { std::filesystem::remove(path); }
};

std::string Header(int width, int height) {
  return "#?RADIANCE\n# a comment\nFORMAT=32-bit_rle_rgbe\n\n-Y " + std::to_string(height) +
         " +X " + std::to_string(width) + "\n";
}

using Pixels = std::vector<std::array<uint8_t, 4>>;

// Long runs of equal bytes, and others; all exponents, 0 too.
Pixels MakePixels(size_t count) {
  std::mt19937 random(7);
  Pixels pixels(count);
  std::array<uint8_t, 4> pixel{};
  for (size_t i = 0; i < count; ++i) {
    if (random() % 9 == 0) {
      for (uint8_t& byte : pixel) byte = static_cast<uint8_t>(random());
      if (random() % 8 == 0) pixel[3] = 0;
      // A row that begins like the sign of a coded one, or of an old repetition, is another story.
      pixel[0] = std::max<uint8_t>(pixel[0], 3);
    }
    pixels[i] = pixel;
  }
  return pixels;
}

std::string Flat(const Pixels& pixels) {
  std::string bytes;
  for (const auto& pixel : pixels) {
    for (const uint8_t byte : pixel) bytes += static_cast<char>(byte);
  }
  return bytes;
}

std::string Coded(const Pixels& pixels, size_t width) {
  std::string bytes;
  for (size_t row = 0; row < pixels.size(); row += width) {
    bytes += {2, 2, static_cast<char>(width >> 8), static_cast<char>(width & 255)};
    for (size_t c = 0; c < 4; ++c) {
      for (size_t x = 0; x < width;) {
        const auto at = [&](size_t i) { return pixels[row + i][c]; };
        size_t same = 1;
        while (x + same < width && same < 127 && at(x + same) == at(x)) ++same;
        if (same > 2) {
          bytes += {static_cast<char>(128 + same), static_cast<char>(at(x))};
        } else {
          bytes += static_cast<char>(same);
          for (size_t i = 0; i < same; ++i) bytes += static_cast<char>(at(x + i));
        }
        x += same;
      }
    }
  }
  return bytes;
}

std::vector<float> RgbOf(const std::string& bytes) {
  const HdrFile file(bytes);
  const Image image = ReadImage(OpenHdr(file.path));
  std::vector<float> values;
  for (size_t i = 0; i < image.data.pixel_count(); ++i) {
    for (const Channel& channel : image.channels) values.push_back(channel.samples[i]);
  }
  return values;
}

// m 2^(e - 136), and 0 for the exponent 0 (Ward 1991).
std::vector<float> Expected(const Pixels& pixels) {
  std::vector<float> values;
  for (const auto& pixel : pixels) {
    for (size_t c = 0; c < 3; ++c) {
      values.push_back(pixel[3] == 0 ? 0.0f
                                     : std::ldexp(static_cast<float>(pixel[c]), pixel[3] - 136));
    }
  }
  return values;
}

TEST_CASE("plain rows and coded ones") {
  CHECK(RgbOf(Header(40, 9) + Flat(MakePixels(360))) == Expected(MakePixels(360)));
  CHECK(RgbOf(Header(300, 5) + Coded(MakePixels(1500), 300)) == Expected(MakePixels(1500)));
  CHECK(RgbOf(Header(8, 3) + Coded(MakePixels(24), 8)) == Expected(MakePixels(24)));
  CHECK(RgbOf(Header(5, 2) + Flat(MakePixels(10))) == Expected(MakePixels(10)));
}

// More than are converted at a time, and more bytes than are read at once.
TEST_CASE("many rows, some plain and some coded") {
  constexpr size_t kWidth = 3000, kRows = 37;
  const Pixels pixels = MakePixels(kWidth * kRows);
  std::string bytes = Header(kWidth, kRows);
  for (size_t y = 0; y < kRows; ++y) {
    const auto first = pixels.begin() + static_cast<std::ptrdiff_t>(y * kWidth);
    const Pixels row(first, first + kWidth);
    bytes += y % 3 == 0 ? Coded(row, kWidth) : Flat(row);
  }
  CHECK(RgbOf(bytes) == Expected(pixels));
}

// Codes up to 128 are bytes as they are, those above it are runs.
TEST_CASE("a code of 128 is 128 bytes as they are") {
  Pixels pixels(130);
  for (size_t i = 0; i < pixels.size(); ++i) {
    pixels[i] = {static_cast<uint8_t>(i), static_cast<uint8_t>(2 * i), 3, 129};
  }
  std::string bytes = Header(130, 1) + std::string("\2\2\0\202", 4);
  for (size_t c = 0; c < 4; ++c) {
    bytes += static_cast<char>(128);
    for (size_t x = 0; x < 128; ++x) bytes += static_cast<char>(pixels[x][c]);
    bytes += static_cast<char>(2);
    for (size_t x = 128; x < 130; ++x) bytes += static_cast<char>(pixels[x][c]);
  }
  CHECK(RgbOf(bytes) == Expected(pixels));
}

// (1, 1, 1, n), and another one for the higher 8 bits of n.
TEST_CASE("the oldest files' repetitions") {
  const std::string pixel = "\10\11\12\201", once("\1\1\1\5", 4), high("\1\1\1\1", 4);
  Pixels pixels(1 + 5 + 256 + 1, {8, 9, 10, 129});
  pixels.back() = {20, 9, 10, 129};
  CHECK(RgbOf(Header(263, 1) + pixel + once + high + "\24\11\12\201") == Expected(pixels));
}

TEST_CASE("a file as long as its pixels repeats nothing") {
  Pixels pixels = MakePixels(24);
  pixels[0] = {1, 1, 1, 200};
  pixels[5] = pixels[6] = {1, 1, 1, 130};
  pixels[8] = {2, 2, 0, 129};  // the second row begins as a coded one of another length would
  CHECK(RgbOf(Header(8, 3) + Flat(pixels)) == Expected(pixels));
}

TEST_CASE("an exposure is divided out") {
  const Pixels pixels = MakePixels(16);
  std::string header = Header(8, 2);
  header.insert(header.find("FORMAT"), "EXPOSURE=4\nEXPOSURE=0.5\nCOLORCORR=1 2 4\n");
  const std::vector<float> got = RgbOf(header + Flat(pixels)), plain = Expected(pixels);
  for (size_t i = 0; i < plain.size(); ++i) {
    CHECK(got[i] == plain[i] / std::exp2(static_cast<float>(1 + i % 3)));
  }
}

// As FreeImage writes an exposure that it does not know.
TEST_CASE("numbers that are 0 say nothing") {
  const Pixels pixels = MakePixels(16);
  for (const char* line : {"EXPOSURE=0", "COLORCORR=0 0 0", "GAMMA=0", "PIXASPECT=0.0"}) {
    CAPTURE(line);
    std::string header = Header(8, 2);
    header.insert(header.find("FORMAT"), std::string(line) + "\n");
    CHECK(RgbOf(header + Flat(pixels)) == Expected(pixels));
  }
}

TEST_CASE("lines of real files: CRLF, signs, blanks and comments with an = in them") {
  const Pixels pixels = MakePixels(16);
  std::string header =
      "#?RGBE\r\n#?RADIANCE\r\n# GAMMA=2.2\r\n\tEXPOSURE=7\r\nrpict -vtv -x=3\r\n"
      "EXPOSURE= +2.0e0 \r\nFORMAT= 32-bit_rle_rgbe \r\n\r\n-Y 2 +X 8\r\n";
  const std::vector<float> got = RgbOf(header + Flat(pixels)), plain = Expected(pixels);
  for (size_t i = 0; i < plain.size(); ++i) CHECK(got[i] == plain[i] / 2);
}

TEST_CASE("old pictures begin without #?, and some end their header by two empty lines") {
  const Pixels pixels = MakePixels(16);
  const std::string bytes = Flat(pixels);
  CHECK(RgbOf("Xim format conversion by:\nFORMAT=32-bit_rle_rgbe\npfilt -x 8\n\n-Y 2 +X 8\n" +
              bytes) == Expected(pixels));
  CHECK(RgbOf("#?RADIANCE\r\nFORMAT=32-bit_rle_rgbe\r\n\n\r\n-Y 2 +X 8\r\n" + bytes) ==
        Expected(pixels));
}

// Radiance's own primaries stay as they are; what names none, or others, is left to whoever shows
// the colours.
TEST_CASE("PRIMARIES are told as EXR's chromaticities") {
  const auto told = [](const std::string& line) {
    std::string header = Header(8, 1);
    header.insert(header.find("FORMAT"), line + "\n");
    const HdrFile file(header + Flat(MakePixels(8)));
    const auto metadata = OpenHdr(file.path).header.metadata;
    const auto found = metadata.find("chromaticities");
    return found == metadata.end() ? std::string("none") : found->second;
  };
  CHECK(told("PRIMARIES=0.640 0.330 0.290 0.600 0.150 0.060 0.333 0.333") == "none");
  CHECK(told("PRIMARIES=0 0 0 0 0 0 0 0") == "0 0 0 0 0 0 0 0");
  CHECK(told("PRIMARIES= .708 .292 .170 .797 .131 .046 .3127 .3290") ==
        ".708 .292 .170 .797 .131 .046 .3127 .3290");
}

// Y of XYZE is in lumens: 179 of them, of equal X, Y and Z, are a white of 1 (pcomb, ra_xyze -r).
TEST_CASE("XYZ pixels become Radiance's RGB") {
  std::string header = Header(8, 1);
  header.replace(header.find("rgbe"), 4, "xyze");
  const std::vector<float> white = RgbOf(header + Flat(Pixels(8, {179, 179, 179, 136})));
  for (const float value : white) CHECK(std::abs(value - 1) < 1e-6);  // a few roundings
  // Red of 1: its xy and luminance, .265074 of white's, from the primaries by RP 177.
  const std::vector<float> red = RgbOf(header + Flat(Pixels(8, {92, 47, 4, 136})));
  CHECK(std::abs(red[0] - 1) < 0.02);  // codes of two digits
  CHECK(std::abs(red[1]) < 0.02);
  CHECK(std::abs(red[2]) < 0.02);
  // Y alone is a green that no RGB has: red and blue would be below 0.
  const std::vector<float> green = RgbOf(header + Flat(Pixels(8, {0, 179, 0, 136})));
  CHECK(green[0] == 0);
  CHECK(green[1] > 1);
  CHECK(green[2] == 0);
}

TEST_CASE("other and broken Radiance files are refused") {
  const std::string whole = Header(20, 3) + Coded(MakePixels(60), 20);
  const auto refusal = [](const std::string& bytes) {
    try {
      RgbOf(bytes);
    } catch (const Error& error) {
      CHECK(error.code() == ExitCode::kBadInput);
      return std::string(error.what());
    }
    return std::string();
  };
  for (size_t size = 0; size < whole.size(); ++size) {
    CAPTURE(size);
    CHECK_FALSE(refusal(whole.substr(0, size)).empty());
  }
  CHECK(refusal(whole).empty());
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string changed = whole;
    return changed.replace(changed.find(from), from.size(), to);
  };
  const auto says = [&](const std::string& bytes, const std::string& words) {
    CAPTURE(words);
    CHECK(refusal(bytes).find(words) != std::string::npos);
  };
  says(with("rgbe", "float"), "its FORMAT is neither");
  says(with("-Y 3", "-Y 0"), "its resolution");
  says(with("-Y 3", "-Y 70000"), "its resolution");
  says(with("-Y 3 +X", "-Y 3 +Y"), "its resolution");
  says(with("+X 20", "+X 21"), "a row is not as long");
  says(with("-Y 3", "-Y 60000"), "cut off");
  says(with("#?RADIANCE", "#?RADIANCE\nEXPOSURE=-1"), "above 0");
  says(with("# a comment", "GAMMA=2.2"), "GAMMA is not 1");
  says(Header(20, 1) + std::string("\1\1\1\24", 4), "a repetition");
}

TEST_CASE("PIXASPECT is height over width, multiplies, and FORMAT may be missing") {
  const std::string pixels = "\n-Y 1 +X 1\n\x80\x80\x80\x80";
  const auto aspect = [&](const std::string& lines) {
    const HdrFile file("#?RADIANCE\n" + lines + pixels);
    return OpenHdr(file.path).header.metadata.at("pixelAspectRatio");
  };
  CHECK(aspect("FORMAT=32-bit_rle_rgbe\nPIXASPECT=2\n") == "0.5");
  CHECK(aspect("PIXASPECT= 1.0\n") == "1");
  CHECK(aspect("PIXASPECT=2\nPIXASPECT=.25\n") == "2");
  const HdrFile negative("#?RADIANCE\nPIXASPECT=-1\n" + pixels);
  CHECK_THROWS_AS(OpenHdr(negative.path), Error);
}

}  // namespace
}  // namespace nacre
