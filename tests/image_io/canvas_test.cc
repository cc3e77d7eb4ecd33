// SPDX-License-Identifier: Apache-2.0
// tests/image_io/canvas_test.cc: pictures that are put together, and written at once.
#include "image_io/canvas.h"

#include <algorithm>
#include <cmath>

#include "files.h"
#include "image_io/exr_compression.h"
#include "image_io/png_writer.h"
#include "image_io/read_image.h"

namespace nacre {
namespace {

constexpr Rgb8 kPaper = {9, 8, 7};

Rgb8 At(const Rgb8Picture& picture, int x, int y) {
  const auto i = 3 * static_cast<size_t>(y * picture.width + x);
  return {picture.rgb8[i], picture.rgb8[i + 1], picture.rgb8[i + 2]};
}

// Each pixel tells where it is.
Rgb8Picture Numbered(int width, int height) {
  Rgb8Picture picture{width, height, {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (const int code : {x, y, 100}) picture.rgb8.push_back(static_cast<uint8_t>(code));
    }
  }
  return picture;
}

TEST_CASE("pictures are pasted where they lie within, cut off elsewhere") {
  for (const int left : {-30, -5, -1, 0, 2, 6, 9, 30}) {
    for (const int top : {-30, -3, 0, 1, 5, 30}) {
      CAPTURE(left, top);
      const Rgb8Picture picture = Numbered(6, 4);
      Canvas canvas(10, 6, kPaper);
      canvas.Paste(picture, left, top);
      const Rgb8Picture& drawn = canvas.Draw();
      for (int y = 0; y < 6; ++y) {
        for (int x = 0; x < 10; ++x) {
          const bool within = x >= left && x < left + 6 && y >= top && y < top + 4;
          CHECK(At(drawn, x, y) == (within ? At(picture, x - left, y - top) : kPaper));
        }
      }
    }
  }
}

TEST_CASE("a part of a picture is pasted enlarged") {
  const Rgb8Picture picture = Numbered(8, 8);
  const Window part{2, 3, 5, 5};
  Canvas canvas(12, 9, kPaper);
  canvas.Paste(picture, part, 4, -2, 3);  // 12 x 8 pixels, of which two columns and rows are cut
  const Rgb8Picture& drawn = canvas.Draw();
  for (int y = 0; y < 9; ++y) {
    for (int x = 0; x < 12; ++x) {
      const bool within = x < 10 && y >= 3;
      CHECK(At(drawn, x, y) == (within ? At(picture, 2 + (x + 2) / 4, 3 + (y - 3) / 4) : kPaper));
    }
  }
}

TEST_CASE("text is drawn once") {
  Canvas canvas(60, 20, kPaper);
  canvas.AddText(PlainText("Text", 2.4, 3.6, 12, AlignX::kLeft, {255, 255, 255}));
  const Rgb8Picture first = canvas.Draw();
  CHECK(first.rgb8 != FilledPicture(60, 20, kPaper).rgb8);
  CHECK(canvas.Draw().rgb8 == first.rgb8);
}

TEST_CASE("a picture written at once is read back") {
  const TestFolder folder;
  for (const int height : {1, 16, 17, 70}) {
    CAPTURE(height);
    const Rgb8Picture picture = Numbered(33, height);
    WritePng(folder / "a.png", picture);
    PngWriter encoded(folder / "b.png", {33, height, {}});
    encoded.WriteAll([&](size_t first, size_t count, uint8_t* rgb8) {
      std::copy_n(picture.rgb8.data() + 3 * first, 3 * count, rgb8);
    });
    encoded.Finish();
    for (const char* name : {"a.png", "b.png"}) {
      const Image image = ReadImage(folder / name);
      REQUIRE(image.data == Window{0, 0, 33, height});
      const char* const channels[] = {"R", "G", "B"};
      for (size_t c = 0; c < 3; ++c) {
        const std::vector<float>& samples = image.Find(channels[c])->samples;
        for (size_t i = 0; i < samples.size(); ++i) {
          if (std::lround(255 * samples[i]) != picture.rgb8[3 * i + c]) FAIL(name << " " << i);
        }
      }
    }
  }
}

TEST_CASE("compressions have names and numbers that lead back to them") {
  CHECK(CompressionNames() == std::vector<std::string>{"none", "zip", "zips", "piz", "dwaa"});
  for (const std::string& name : CompressionNames()) {
    const Compression compression = ParseCompression(name);
    CHECK(CompressionName(compression) == name);
    CHECK(CompressionOfNumber(CompressionNumber(compression)) == compression);
  }
  CHECK_FALSE(CompressionOfNumber(1).has_value());  // RLE
  CHECK_THROWS_AS(ParseCompression("rle"), Error);
}

}  // namespace
}  // namespace nacre
