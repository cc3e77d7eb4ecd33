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
