// SPDX-License-Identifier: Apache-2.0
// tests/image_io/webp_reader_test.cc: WebP files of every kind, and damaged ones.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <webp/encode.h>

#include "catch.h"
#include "files.h"
#include "image_io/format_readers.h"
#include "image_io/read_image.h"

namespace nacre {
namespace {

constexpr int kWide = 13, kHigh = 11;

std::vector<uint8_t> MakeCodes() {
  std::vector<uint8_t> codes;
  for (int i = 0; i < kWide * kHigh; ++i) {
    codes.push_back(static_cast<uint8_t>(i));
    codes.push_back(static_cast<uint8_t>(255 - i));
    codes.push_back(static_cast<uint8_t>(i * 7));
    codes.push_back(static_cast<uint8_t>(255 - i * 3));
  }
  return codes;
}

// With libwebp. Pixels without any opacity would lose their colour: there are none.
std::string Lossless(std::vector<uint8_t> codes, bool alpha) {
  if (!alpha) {
    for (size_t i = 3; i < codes.size(); i += 4) codes[i] = 255;
  }
  for (size_t i = 3; i < codes.size(); i += 4) codes[i] = std::max<uint8_t>(codes[i], 1);
  uint8_t* bytes = nullptr;
  const size_t size = WebPEncodeLosslessRGBA(codes.data(), kWide, kHigh, 4 * kWide, &bytes);
  const std::unique_ptr<uint8_t, decltype(&WebPFree)> owner(bytes, &WebPFree);
  return {bytes, bytes + size};
}

std::string Word(size_t value) {
  std::string bytes;
  for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(value >> shift);
  return bytes;
}

// The same picture in the extended form (WebP Container Specification, 2.7), with another chunk.
std::string Extended(const std::string& simple, uint8_t flags, const std::string& chunk) {
  const std::string canvas = Word(kWide - 1).substr(0, 3) + Word(kHigh - 1).substr(0, 3);
  const std::string head = std::string("VP8X") + Word(10) + Word(flags) + canvas;
  const std::string body = "WEBP" + head + simple.substr(12) + chunk;
  return "RIFF" + Word(body.size()) + body;
}

// EXIF of one entry, the orientation.
std::string ExifChunk(uint8_t orientation) {
  const std::string tiff = std::string("II*\0", 4) + Word(8) + std::string("\1\0\x12\1\3\0", 6) +
                           Word(1) + Word(orientation) + Word(0);
  return "EXIF" + Word(tiff.size()) + tiff;
}

float ValueAt(const Image& image, const char* channel, int x, int y) {
  return image.Find(channel)->samples[static_cast<size_t>(y * image.data.width() + x)];
}

TEST_CASE("lossless WebP files have the codes that went into them, in the rows of a picture") {
  const TestFolder folder;
  const std::vector<uint8_t> codes = MakeCodes();
  for (const bool alpha : {false, true}) {
    WriteText(folder / "a.png", Lossless(codes, alpha));  // the name does not count
    const Image image = ReadImage(folder / "a.png");
    REQUIRE(image.channels.size() == (alpha ? 4 : 3));
    CHECK(image.metadata.at("transfer") == "display");
    for (int y = 0; y < kHigh; ++y) {
      for (int x = 0; x < kWide; ++x) {
        const size_t i = 4 * static_cast<size_t>(y * kWide + x);
        CHECK(ValueAt(image, "R", x, y) == static_cast<float>(codes[i]) / 255);
        CHECK(ValueAt(image, "B", x, y) == static_cast<float>(codes[i + 2]) / 255);
        if (!alpha) continue;
        const uint8_t opacity = std::max<uint8_t>(codes[i + 3], 1);
        CHECK(ValueAt(image, "A", x, y) == static_cast<float>(opacity) / 255);
      }
    }
  }
}

TEST_CASE("a lossy WebP file is near to what it was made of") {
  const TestFolder folder;
  std::vector<uint8_t> codes(static_cast<size_t>(kWide * kHigh) * 3);
  for (size_t i = 0; i < codes.size(); ++i) codes[i] = static_cast<uint8_t>(60 + i / 12);
  uint8_t* bytes = nullptr;
  const size_t size = WebPEncodeRGB(codes.data(), kWide, kHigh, 3 * kWide, 95, &bytes);
  const std::unique_ptr<uint8_t, decltype(&WebPFree)> owner(bytes, &WebPFree);
  WriteText(folder / "a.webp", std::string(bytes, bytes + size));
  const Image image = ReadImage(folder / "a.webp");
  REQUIRE(image.channels.size() == 3);
  for (int y = 0; y < kHigh; ++y) {
    const size_t i = 3 * static_cast<size_t>(y * kWide + 5);
    // Quality 95, whose colours have half the resolution: some codes.
    CHECK(std::abs(ValueAt(image, "G", 5, y) - static_cast<float>(codes[i + 1]) / 255) < 0.03);
  }
}

TEST_CASE("WebP files are turned as EXIF says, and their colour profile is told") {
  const TestFolder folder;
  const std::string simple = Lossless(MakeCodes(), false);
  WriteText(folder / "a.webp", simple);
  const Image plain = ReadImage(folder / "a.webp");
  WriteText(folder / "b.webp", Extended(simple, 8, ExifChunk(6)));  // its top is at the right
  const Image turned = ReadImage(folder / "b.webp");
  REQUIRE(turned.data.width() == kHigh);
  REQUIRE(turned.data.height() == kWide);
  CHECK(ValueAt(turned, "G", kHigh - 1, 0) == ValueAt(plain, "G", 0, 0));
  CHECK(ValueAt(turned, "G", 0, kWide - 1) == ValueAt(plain, "G", kWide - 1, kHigh - 1));
  const std::string profile = "no profile";
  const std::string chunk = "ICCP" + Word(profile.size()) + profile;
  // The profile comes before the picture.
  std::string file = Extended(simple, 32, "");
  file.insert(30, chunk);
  file.replace(4, 4, Word(file.size() - 8));
  WriteText(folder / "c.webp", file);
  CHECK(ReadImage(folder / "c.webp").metadata.contains("not_srgb"));
}

TEST_CASE("WebP files that are cut off, damaged or animated are refused") {
  const TestFolder folder;
  const std::string whole = Lossless(MakeCodes(), true);
  for (size_t size = 12; size < whole.size(); size += size < 60 ? 1 : 37) {
    CAPTURE(size);
    WriteText(folder / "a.webp", whole.substr(0, size));
    const Caught caught = Catching([&] { ReadImage(folder / "a.webp"); });
    CHECK(caught.code == ExitCode::kBadInput);
    CHECK(caught.Says("a.webp"));
  }
  for (size_t at = 12; at < whole.size(); at += 3) {
    std::string flipped = whole;
    flipped[at] = static_cast<char>(flipped[at] ^ 0x55);
    WriteText(folder / "a.webp", flipped);
    Catching([&] { ReadImage(folder / "a.webp"); });  // other pixels, or an Error
  }
  WriteText(folder / "a.webp", Extended(whole, 2, ""));
  const Caught caught = Catching([&] { ReadImage(folder / "a.webp"); });
  CHECK(caught.code == ExitCode::kBadInput);
  CHECK(caught.Says("animation"));
}

}  // namespace
}  // namespace nacre
