// SPDX-License-Identifier: Apache-2.0
// tests/image_io/exr_checksum_test.cc: the checksum in EXR files, and files that are proven whole.
#include "image_io/exr_checksum.h"

#include <algorithm>
#include <string_view>

#include <zlib.h>

#include "base/error.h"
#include "image_io/exr_bands.h"
#include "image_io/png_writer.h"
#include "image_io/read_image.h"
#include "pictures.h"

namespace nacre {
namespace {

const std::vector<Compression> kAllCompressions = {Compression::kNone, Compression::kZip,
                                                   Compression::kZips, Compression::kPiz,
                                                   Compression::kDwaa};

std::span<const uint8_t> BytesOf(std::string_view text) {
  return {reinterpret_cast<const uint8_t*>(text.data()), text.size()};
}

TEST_CASE("the checksum is the CRC-32 of zlib, gzip and PNG") {
  CHECK(Crc32(0, {}) == 0);
  CHECK(Crc32(0, BytesOf("123456789")) == 0xcbf43926);  // the check value of CRC-32/ISO-HDLC
  const std::vector<uint8_t> bytes = {0x89, 0, 255, 7, 3, 1, 128, 64};
  const std::span<const uint8_t> all(bytes);
  const uint32_t whole = Crc32(0, all);
  CHECK(whole == crc32(0, bytes.data(), 8));
  for (size_t cut = 0; cut <= bytes.size(); ++cut) {
    CHECK(Crc32(Crc32(0, all.first(cut)), all.subspan(cut)) == whole);
    CHECK(CombineCrc32(Crc32(0, all.first(cut)), Crc32(0, all.subspan(cut)), bytes.size() - cut) ==
          whole);
  }
  CHECK(ExrChecksumDigits(0xabc) == "00000abc");
}

TEST_CASE("every file that is written has the checksum of its bytes") {
  const TestFolder folder;
  for (const Compression compression : kAllCompressions) {
    CAPTURE(static_cast<int>(compression));
    Picture picture = MakePicture(37, 75);
    picture.header.attributes["a number"] = 7;
    ExrWriter writer(folder / "a.exr", picture.header, {.compression = compression});
    for (size_t i = StripCount(picture); i-- > 0;) writer.WriteStrip(ViewStrip(picture, i));
    writer.UpdateAttribute("a number", 8);  // what is known late counts too
    writer.Finish();
    CHECK(CheckExrChecksum(folder / "a.exr") == ExrChecksum::kRight);
    CHECK_NOTHROW(VerifyImage(folder / "a.exr"));
    CHECK(ExrBandReader(folder / "a.exr").ReadHeader().header.attributes.size() == 1);

    const std::vector<uint8_t> bytes = ReadBytes(folder / "a.exr");
    size_t unnoticed = 0;
    for (size_t at = 0; at < bytes.size(); at += 1 + bytes.size() / 300) {
      std::vector<uint8_t> flipped = bytes;
      flipped[at] ^= static_cast<uint8_t>(1 << at % 8);
      WriteBytes(folder / "b.exr", flipped);
      unnoticed += CheckExrChecksum(folder / "b.exr") == ExrChecksum::kRight;
    }
    CHECK(unnoticed == 0);
  }
}

// Files are read a mebibyte at a time.
TEST_CASE("the checksum counts what is behind the first mebibyte") {
  const TestFolder folder;
  WritePicture(folder / "a.exr", MakePicture(640, 480), {.compression = Compression::kNone});
  std::vector<uint8_t> bytes = ReadBytes(folder / "a.exr");
  constexpr size_t kMebibyte = size_t{1} << 20;
  REQUIRE(bytes.size() > 2 * kMebibyte);
  REQUIRE(CheckExrChecksum(folder / "a.exr") == ExrChecksum::kRight);
  for (const size_t at : {kMebibyte - 1, kMebibyte, 3 * kMebibyte / 2, 2 * kMebibyte - 1,
                          2 * kMebibyte, bytes.size() - 1}) {
    CAPTURE(at);
    bytes[at] ^= 0x10;
    WriteBytes(folder / "b.exr", bytes);
    bytes[at] ^= 0x10;
    CHECK(CheckExrChecksum(folder / "b.exr") == ExrChecksum::kWrong);
    CHECK_THROWS_AS(VerifyImage(folder / "b.exr"), Error);
  }
}

TEST_CASE("files without a checksum have none, and those that cannot be read neither") {
  const TestFolder folder;
  CHECK(CheckExrChecksum(folder / "missing.exr") == ExrChecksum::kNone);
  CHECK(CheckExrChecksum(folder.path().string()) == ExrChecksum::kNone);
  for (const char* text : {"", "v/1\x01", "not a picture at all, but longer than its header is"}) {
    WriteText(folder / "a.exr", text);
    CHECK(CheckExrChecksum(folder / "a.exr") == ExrChecksum::kNone);
  }
  WritePicture(folder / "a.exr", MakePicture(5, 5), {});
  std::vector<uint8_t> bytes = ReadBytes(folder / "a.exr");
  const std::string_view name = kExrChecksumAttribute;
  const auto found = std::search(bytes.begin(), bytes.end(), name.begin(), name.end());
  REQUIRE(found != bytes.end());
  *found = 'N';
  WriteBytes(folder / "a.exr", bytes);
  CHECK(CheckExrChecksum(folder / "a.exr") == ExrChecksum::kNone);
  CHECK_NOTHROW(VerifyImage(folder / "a.exr"));  // it decodes
  *found = 'n';
  found[static_cast<ptrdiff_t>(name.size()) + 1] = 'S';  // of the type's name
  WriteBytes(folder / "a.exr", bytes);
  CHECK(CheckExrChecksum(folder / "a.exr") == ExrChecksum::kWrong);
}

TEST_CASE("a picture that is proven holds all of itself") {
  const TestFolder folder;
  PngHeader header;
  header.width = 300;
  header.height = 70;
  header.text = {{"Software", "nacre"}};
  std::vector<uint8_t> rgb8(3 * 300 * 70);
  for (size_t i = 0; i < rgb8.size(); ++i) rgb8[i] = static_cast<uint8_t>(i * i >> 5);
  PngWriter png(folder / "a.png", header);
  for (int y = 0; y < 70; y += kStripRows) {
    png.WriteStrip(y, std::min(kStripRows, 70 - y), &rgb8[static_cast<size_t>(y) * 900]);
  }
  png.Finish();
  CHECK_NOTHROW(VerifyImage(folder / "a.png"));
  const std::vector<uint8_t> bytes = ReadBytes(folder / "a.png");
  size_t unnoticed = 0;
  for (size_t at = 0; at < bytes.size(); at += 1 + bytes.size() / 500) {
    std::vector<uint8_t> flipped = bytes;
    flipped[at] ^= static_cast<uint8_t>(1 << at % 8);
    WriteBytes(folder / "b.png", flipped);
    unnoticed += Catching([&] { VerifyImage(folder / "b.png"); }).code != ExitCode::kBadInput;
    flipped.resize(at);  // cut off
    WriteBytes(folder / "b.png", flipped);
    unnoticed += Catching([&] { VerifyImage(folder / "b.png"); }).code != ExitCode::kBadInput;
  }
  CHECK(unnoticed == 0);
  CHECK(Catching([&] { VerifyImage(folder / "missing.png"); }).code == ExitCode::kBadInput);
  CHECK(Catching([&] { VerifyImage(folder.path().string()); }).code == ExitCode::kBadInput);
}

}  // namespace
}  // namespace nacre
