// SPDX-License-Identifier: Apache-2.0
// tests/image_io/png_reader_test.cc: plain PNG files against OpenImageIO, and what is left to it.
#include "image_io/png_reader.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include <zlib.h>

#include "catch.h"
#include "image_io/oiio.h"

namespace nacre {
namespace {

std::optional<Image> ReadPlain(const std::string& path) {
  const std::optional<ImageFile> file = OpenPlainPng(path);
  if (!file) return {};
  return ReadImage(*file);
}

std::string ReadBytes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST_CASE("plain PNG files read as OpenImageIO reads them") {
  size_t count = 0;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(NACRE_SOURCE_DIR "/scenes")) {
    if (entry.path().extension() != ".png") continue;
    CAPTURE(entry.path().string());
    const auto got = ReadPlain(entry.path().string());
    if (!got) continue;  // gnuplot's have a transparent palette
    ++count;
    const Image expected = ReadImage(OpenWithOiio(entry.path().string()));
    CHECK(got->data == expected.data);
    CHECK(got->metadata.at("transfer") == expected.metadata.at("transfer"));
    REQUIRE(got->channels.size() == expected.channels.size());
    for (size_t c = 0; c < got->channels.size(); ++c) {
      CHECK(got->channels[c].name == expected.channels[c].name);
      float worst = 0;
      for (size_t i = 0; i < got->channels[c].samples.size(); ++i) {
        worst = std::max(worst,
                         std::abs(got->channels[c].samples[i] - expected.channels[c].samples[i]));
      }
      // OpenImageIO multiplies by 1/255, rounded; this divides.
      CHECK(worst <= 1.2e-7f);
    }
  }
  CHECK(count >= 10);
}

std::string Chunk(const std::string& type, const std::string& data) {
  const auto big32 = [](uint64_t value) {
    std::string bytes;
    for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift);
    return bytes;
  };
  const std::string content = type + data;
  const auto* const bytes = reinterpret_cast<const Bytef*>(content.data());
  return big32(data.size()) + content + big32(crc32(0, bytes, static_cast<uInt>(content.size())));
}

std::string Compressed(const std::string& text) {
  std::string packed(compressBound(text.size()), '\0');
  uLongf size = packed.size();
  REQUIRE(compress(reinterpret_cast<Bytef*>(packed.data()), &size,
                   reinterpret_cast<const Bytef*>(text.data()), text.size()) == Z_OK);
  packed.resize(size);
  return packed;
}

TEST_CASE("texts of every kind are shown, and take the place of nothing that chunks say") {
  using std::string_literals::operator""s;
  const std::string good = ReadBytes(NACRE_SOURCE_DIR "/scenes/textures/tiles.png");
  const std::string copy =
      (std::filesystem::temp_directory_path() / "nacre_png_texts_test.png").string();
  const auto metadata = [&](const std::string& chunks) {
    constexpr size_t kHeader = 8 + 25;  // the signature and IHDR
    std::ofstream(copy, std::ios::binary)
        << good.substr(0, kHeader) << chunks << good.substr(kHeader);
    std::optional<Image> image = ReadPlain(copy);
    REQUIRE(image.has_value());
    return image->metadata;
  };
  const auto before = metadata("");
  const auto texts = metadata(
      Chunk("tEXt", "Author\0Herv\xe9 \xa9"s) + Chunk("tEXt", "Author\0again"s) +
      Chunk("tEXt", "nacre:scene\0ball"s) + Chunk("zTXt", "Comment\0\0"s + Compressed("packed")) +
      Chunk("iTXt", "Title\0\0\0fr\0Titre\0caf\xc3\xa9"s) +
      Chunk("iTXt", "Source\0\1\0\0\0"s + Compressed("packed, too")) +
      // What could be taken for words of other chunks, or for nacre's own.
      Chunk("tEXt", "transfer\0linear"s) + Chunk("zTXt", "not_srgb\0\0"s + Compressed("a lie")) +
      Chunk("iTXt", "gamma\0\0\0\0\0"s + "7"));
  auto expected = before;
  expected["png:Author"] = "Herv\xc3\xa9 \xc2\xa9";
  expected["nacre:scene"] = "ball";
  expected["png:Comment"] = "packed";
  expected["png:Title"] = "caf\xc3\xa9";
  expected["png:Source"] = "packed, too";
  expected["png:transfer"] = "linear";
  expected["png:not_srgb"] = "a lie";
  expected["png:gamma"] = "7";
  CHECK(texts == expected);
  // Megabytes in a few bytes, damage, and chunks that end before they begin.
  const std::string huge = Compressed(std::string(50'000'000, 'x'));
  CHECK(metadata(Chunk("zTXt", "Comment\0\0"s + huge)).at("png:Comment").size() == 1 << 16);
  CHECK(metadata(Chunk("zTXt", "Comment\0\0nothing"s)).at("png:Comment") == "(damaged)");
  for (const char* type : {"tEXt", "zTXt", "iTXt"}) {
    for (const std::string& data : {""s, "Key"s, "Key\0"s, "Key\0\1"s, "Key\0\1\0"s, "\0\0\0"s}) {
      CAPTURE(type, data);
      metadata(Chunk(type, data));
    }
  }
  std::filesystem::remove(copy);
}

TEST_CASE("broken, truncated and other files are left to OpenImageIO") {
  const std::string path = NACRE_SOURCE_DIR "/scenes/textures/tiles.png";
  const std::string good = ReadBytes(path);
  REQUIRE(ReadPlain(path).has_value());
  CHECK_FALSE(OpenPlainPng(NACRE_SOURCE_DIR "/scenes/none.png").has_value());
  CHECK_FALSE(OpenPlainPng(NACRE_SOURCE_DIR "/scenes/first_scene.json").has_value());
  const std::string copy =
      (std::filesystem::temp_directory_path() / "nacre_png_reader_test.png").string();
  const auto reads = [&](const std::string& bytes) {
    std::ofstream(copy, std::ios::binary) << bytes;
    return ReadPlain(copy).has_value();
  };
  CHECK(reads(good));
  // Cut off anywhere, and one bit of any byte changed: the checksums tell.
  for (size_t i = 0; i < good.size(); i += 7) {
    CAPTURE(i);
    CHECK_FALSE(reads(good.substr(0, i)));
    std::string changed = good;
    changed[i] = static_cast<char>(changed[i] ^ 4);
    CHECK_FALSE(reads(changed));
  }
  std::filesystem::remove(copy);
}

}  // namespace
}  // namespace nacre
