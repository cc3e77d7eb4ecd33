// SPDX-License-Identifier: Apache-2.0
// tests/image_io/tga_reader_test.cc: TGA files of every kind, and broken ones.
#include <string>
#include <vector>

#include "files.h"
#include "image_io/format_readers.h"
#include "image_io/read_image.h"

namespace nacre {
namespace {

using Bytes = std::vector<uint8_t>;

struct Tga {
  uint8_t kind = 2, bits = 24, descriptor = 0x20;
  uint8_t width = 2, height = 2;
  bool has_palette = false;
  uint8_t first_color = 0, colors = 0, color_bits = 24;
  Bytes body;  // palette and pixels
};

Bytes Write(const Tga& tga) {
  Bytes bytes = {0,          static_cast<uint8_t>(tga.has_palette ? 1 : 0),
                 tga.kind,   tga.first_color,
                 0,          tga.colors,
                 0,          static_cast<uint8_t>(tga.has_palette ? tga.color_bits : 0),
                 0,          0,
                 0,          0,
                 tga.width,  0,
                 tga.height, 0,
                 tga.bits,   tga.descriptor};
  bytes.insert(bytes.end(), tga.body.begin(), tga.body.end());
  return bytes;
}

// Channel by channel, row by row.
std::vector<float> Read(const Tga& tga) {
  const TestFolder folder;
  WriteBytes(folder / "a.tga", Write(tga));
  std::vector<float> values;
  for (const Channel& channel : ReadImage(OpenTga(folder / "a.tga")).channels) {
    values.insert(values.end(), channel.samples.begin(), channel.samples.end());
  }
  return values;
}

bool IsRefused(const Tga& tga, const std::string& words) {
  const Caught caught = Catching([&] { Read(tga); });
  return caught.code == ExitCode::kBadInput && caught.Says("a.tga: cannot be read: ") &&
         caught.Says(words);
}

using Values = std::vector<float>;

TEST_CASE("TGA colours of all sizes, from every corner") {
  // Blue, green, red of red, green, blue, white.
  const Bytes four = {0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255};
  CHECK(Read({.body = four}) == Values{1, 0, 0, 1, 0, 1, 0, 1, 0, 0, 1, 1});
  CHECK(Read({.descriptor = 0x00, .body = four}) == Values{0, 1, 1, 0, 0, 1, 0, 1, 1, 1, 0, 0});
  CHECK(Read({.descriptor = 0x30, .body = four}) == Values{0, 1, 1, 0, 1, 0, 1, 0, 0, 0, 1, 1});
  // 32 bits, with bits of alpha and without.
  const Bytes one = {51, 102, 153, 204};
  CHECK(Read({.bits = 32, .descriptor = 0x28, .width = 1, .height = 1, .body = one}) ==
        Values{0.6f, 0.4f, 0.2f, 0.8f});
  CHECK(Read({.bits = 32, .width = 1, .height = 1, .body = one}) == Values{0.6f, 0.4f, 0.2f});
  // 5 bits each, and the highest one for alpha.
  const Bytes five = {0x1f, 0x80};
  CHECK(Read({.bits = 16, .descriptor = 0x21, .width = 1, .height = 1, .body = five}) ==
        Values{0, 0, 1, 1});
  CHECK(Read({.bits = 15, .width = 1, .height = 1, .body = five}) == Values{0, 0, 1});
  CHECK(Read({.kind = 3, .bits = 8, .width = 2, .height = 1, .body = {0, 51}}) == Values{0, 0.2f});
}

TEST_CASE("TGA palettes, whose first colour may have any number") {
  const Bytes palette_and_pixels = {0, 0, 255, 255, 255, 255, /* pixels: */ 5, 6, 6, 5};
  const Tga tga{.kind = 1,
                .bits = 8,
                .has_palette = true,
                .first_color = 5,
                .colors = 2,
                .body = palette_and_pixels};
  CHECK(Read(tga) == Values{1, 1, 1, 1, 0, 1, 1, 0, 0, 1, 1, 0});
  for (const uint8_t index : {uint8_t{4}, uint8_t{7}, uint8_t{255}}) {
    Tga beyond = tga;
    beyond.body.back() = index;
    CHECK(IsRefused(beyond, "beyond its palette"));
  }
  Tga empty = tga;
  empty.colors = 0;
  CHECK(IsRefused(empty, "beyond its palette"));
}

TEST_CASE("TGA runs, which may cross rows but not the end") {
  // Three of a grey, then one as it is.
  CHECK(Read({.kind = 11, .bits = 8, .body = {0x82, 51, 0x00, 255}}) ==
        Values{0.2f, 0.2f, 0.2f, 1});
  CHECK(IsRefused({.kind = 11, .bits = 8, .body = {0x84, 51}}, "a run is longer"));
  CHECK(IsRefused({.kind = 11, .bits = 8, .body = {0x81, 51}}, "ends too early"));
}

TEST_CASE("broken TGA files are refused") {
  CHECK(IsRefused({.body = {1, 2, 3}}, "ends too early"));
  CHECK(IsRefused({.kind = 1, .bits = 8, .body = Bytes(4)}, "no palette"));
  CHECK(IsRefused({.kind = 4, .body = Bytes(12)}, "known kind"));
  CHECK(IsRefused({.bits = 7, .body = Bytes(12)}, "size"));
  CHECK(IsRefused({.width = 0, .body = Bytes(12)}, "no pixels"));
  const TestFolder folder;
  WriteBytes(folder / "a.tga", {1, 2, 3});
  CHECK(Catching([&] { OpenTga(folder / "a.tga"); }).Says("ends too early"));
}

}  // namespace
}  // namespace nacre
