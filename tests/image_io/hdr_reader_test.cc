// SPDX-License-Identifier: Apache-2.0
// tests/image_io/hdr_reader_test.cc: plain Radiance files against OpenImageIO, and what is left to
// it.
#include "image_io/hdr_reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include <unistd.h>

#include "catch.h"
#include "image_io/oiio.h"

namespace nacre {
namespace {

constexpr uint64_t kAny = uint64_t{1} << 30;

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
  return "#?RADIANCE\n# a comment\nEXPOSURE=2\nFORMAT=32-bit_rle_rgbe\n\n-Y " +
         std::to_string(height) + " +X " + std::to_string(width) + "\n";
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

void CheckLikeOiio(const std::string& bytes) {
  const HdrFile file(bytes);
  const auto got = ReadPlainHdr(file.path, kAny);
  REQUIRE(got);
  const Image expected = ReadWithOiio(file.path);
  CHECK(got->data == expected.data);
  CHECK(got->metadata.at("transfer") == expected.metadata.at("transfer"));
  REQUIRE(got->channels.size() == 3);
  REQUIRE(expected.channels.size() == 3);
  for (size_t c = 0; c < 3; ++c) {
    CHECK(got->channels[c].name == expected.channels[c].name);
    float worst = 0;
    for (size_t i = 0; i < got->channels[c].samples.size(); ++i) {
      const float a = got->channels[c].samples[i], b = expected.channels[c].samples[i];
      worst = std::max(worst, a == b ? 0.0f : std::abs(a - b) / a);
    }
    // Eight bits times a power of two are exact here; OpenImageIO's powers are off by a digit.
    CHECK(worst <= 0x1p-23f);
  }
}

TEST_CASE("plain Radiance files read as OpenImageIO reads them") {
  CheckLikeOiio(Header(40, 9) + Flat(MakePixels(360)));
  CheckLikeOiio(Header(300, 5) + Coded(MakePixels(1500), 300));
  CheckLikeOiio(Header(8, 3) + Coded(MakePixels(24), 8));
  CheckLikeOiio(Header(5, 2) + Flat(MakePixels(10)));
}

TEST_CASE("a run of 128 is of bytes as they are, the longest of them") {
  // Two rows of 130: of each component 128 bytes as they are, then one byte twice.
  constexpr size_t kWidth = 130;
  Pixels pixels = MakePixels(2 * kWidth);
  std::string bytes;
  for (size_t row = 0; row < pixels.size(); row += kWidth) {
    pixels[row + 129] = pixels[row + 128];
    bytes += {2, 2, static_cast<char>(kWidth >> 8), static_cast<char>(kWidth & 255)};
    for (size_t c = 0; c < 4; ++c) {
      bytes += static_cast<char>(128);
      for (size_t x = 0; x < 128; ++x) bytes += static_cast<char>(pixels[row + x][c]);
      bytes += {static_cast<char>(130), static_cast<char>(pixels[row + 128][c])};
    }
  }
  CheckLikeOiio(Header(kWidth, 2) + bytes);
  const HdrFile coded(Header(kWidth, 2) + bytes), flat(Header(kWidth, 2) + Flat(pixels));
  const auto got = ReadPlainHdr(coded.path, kAny);
  const auto expected = ReadPlainHdr(flat.path, kAny);
  REQUIRE((got && expected));
  for (size_t c = 0; c < 3; ++c) CHECK(got->channels[c].samples == expected->channels[c].samples);
}

TEST_CASE("other and broken Radiance files are left to OpenImageIO") {
  const std::string whole = Header(20, 3) + Coded(MakePixels(60), 20);
  for (size_t size = 0; size < whole.size(); ++size) {
    const HdrFile file(whole.substr(0, size));
    CHECK_FALSE(ReadPlainHdr(file.path, kAny));
  }
  const auto is_left = [](const std::string& bytes, uint64_t max_samples = kAny) {
    const HdrFile file(bytes);
    return !ReadPlainHdr(file.path, max_samples);
  };
  CHECK_FALSE(is_left(whole));
  CHECK_FALSE(is_left(whole, 180));
  CHECK(is_left(whole, 179));
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string changed = whole;
    return changed.replace(changed.find(from), from.size(), to);
  };
  CHECK(is_left(with("rgbe", "xyze")));
  CHECK(is_left(with("-Y 3 +X", "+Y 3 +X")));
  CHECK(is_left(with("-Y 3", "-Y 0")));
  CHECK(is_left(with("-Y 3", "-Y 70000")));
  CHECK(is_left(with("+X 20", "+X 21")));
  CHECK(is_left(with("-Y 3", "-Y 60000")));
  CHECK(is_left(with("#?RADIANCE", "#?PICTURE")));
  CHECK_FALSE(ReadPlainHdr("/nowhere.hdr", kAny));
}

}  // namespace
}  // namespace nacre
