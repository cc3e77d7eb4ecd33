// SPDX-License-Identifier: Apache-2.0
// tests/image_io/image_file_test.cc: images of any format, and text in them, by OpenImageIO.
#include <algorithm>
#include <cmath>

#include "image_io/draw_text.h"
#include "image_io/read_image.h"
#include "pictures.h"

namespace nacre {
namespace {

TEST_CASE("EXR files are linear") {
  const TestFolder folder;
  const Picture picture = MakePicture(5, 5);
  WritePicture(folder / "a.EXR", picture, {});
  const Image image = ReadImage(folder / "a.EXR");
  CheckSamePicture(image, picture);
  CHECK(image.metadata.at("transfer") == "linear");
}

TEST_CASE("PFM files are linear") {
  const TestFolder folder;
  const std::vector<float> pixels = {0.25f, 2.0f, -1.0f, 1e6f, 0.0f, 3.5f};
  std::string file = "PF\n2 1\n-1.0\n";
  file.append(reinterpret_cast<const char*>(pixels.data()), pixels.size() * sizeof(float));
  WriteText(folder / "a.pfm", file);
  const Image image = ReadImage(folder / "a.pfm");
  CHECK(image.metadata.at("transfer") == "linear");
  CHECK(image.Find("R")->samples == std::vector<float>{0.25f, 1e6f});
  CHECK(image.Find("B")->samples == std::vector<float>{-1.0f, 3.5f});
}

// An 8-bit RGBA TGA file of one pixel: colours are the file's, not multiplied by alpha.
TEST_CASE("alpha leaves colours alone") {
  const TestFolder folder;
  std::vector<uint8_t> tga = {0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 1, 0, 32, 0x28};
  tga.insert(tga.end(), {51, 102, 255, 128});  // B G R A
  WriteBytes(folder / "a.tga", tga);
  const Image image = ReadImage(folder / "a.tga");
  CHECK(image.metadata.at("transfer") == "display");
  // Half an ulp of 1: a division or a multiplication by its inverse.
  const auto near = [](float value, float code) {
    return std::abs(value - code / 255) <= 0x1p-24f;
  };
  CHECK(near(image.Find("R")->samples[0], 255));
  CHECK(near(image.Find("G")->samples[0], 102));
  CHECK(near(image.Find("B")->samples[0], 51));
  CHECK(near(image.Find("A")->samples[0], 128));
}

TEST_CASE("what is no image is refused") {
  const TestFolder folder;
  WriteText(folder / "text.png", "not a picture");
  WriteBytes(folder / "empty.png", {});
  WriteText(folder / "a.unknown", "x");
  // A PNG that promises 2^31 - 1 pixels squared.
  WriteBytes(folder / "huge.pfm", {'P', 'F', '\n', '9',  '9', '9', '9',  '9', ' ', '9', '9',
                                   '9', '9', '9',  '\n', '-', '1', '\n', 0,   0,   0,   0});
  for (const char* name : {"text.png", "empty.png", "a.unknown", "absent.png", "huge.pfm"}) {
    CAPTURE(name);
    const Caught caught = Catching([&] { ReadImage(folder / name); });
    CHECK(caught.code == ExitCode::kBadInput);
    CHECK(caught.Says(name));
  }
  CHECK(Catching([&] { ReadImage(folder.path()); }).code == ExitCode::kBadInput);
}

// The smallest window that holds all pixels of which `changed` is true.
template <class Changed>
Window Bounds(int width, int height, const Changed& changed) {
  Window bounds = {width, height, 0, 0};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      if (!changed(static_cast<size_t>(y * width + x))) continue;
      bounds = {std::min(bounds.x0, x), std::min(bounds.y0, y), std::max(bounds.x1, x + 1),
                std::max(bounds.y1, y + 1)};
    }
  }
  return bounds;
}

constexpr int kWidth = 300, kHeight = 100;

std::vector<uint8_t> DrawOn(uint8_t background, const TextItem& item) {
  std::vector<uint8_t> rgb8(3 * kWidth * kHeight, background);
  DrawText(rgb8, kWidth, kHeight, {item});
  return rgb8;
}

TEST_CASE("labels read on any background") {
  for (const uint8_t background : std::vector<uint8_t>{0, 128, 255}) {
    const std::vector<uint8_t> rgb8 =
        DrawOn(background, {.text = "roughness 0.3", .x = 20, .y = 30, .size_px = 24});
    CHECK(std::ranges::count(rgb8, 255) > 300);  // the strokes, white
    CHECK(std::ranges::count_if(rgb8, [](uint8_t v) { return v < 32; }) > 300);  // the outline
  }
}

TEST_CASE("labels have colours") {
  const std::vector<uint8_t> rgb8 =
      DrawOn(0, {.text = "M", .x = 20, .y = 30, .size_px = 40, .color = {255, 128, 0}});
  bool found = false;
  for (size_t i = 0; i < rgb8.size(); i += 3) {
    found = found || (rgb8[i] == 255 && rgb8[i + 1] == 128 && rgb8[i + 2] == 0);
  }
  CHECK(found);
}

TEST_CASE("labels are aligned") {
  constexpr int kX = 150, kY = 50, kSize = 24;
  // A descender is about a quarter of the size, an outline a twelfth.
  constexpr int kSlack = kSize / 4;
  for (const AlignX align_x : {AlignX::kLeft, AlignX::kCenter, AlignX::kRight}) {
    for (const AlignY align_y : {AlignY::kTop, AlignY::kCenter, AlignY::kBottom}) {
      CAPTURE(static_cast<int>(align_x), static_cast<int>(align_y));
      const std::vector<uint8_t> rgb8 = DrawOn(128, {.text = "MgM",
                                                     .x = kX,
                                                     .y = kY,
                                                     .size_px = kSize,
                                                     .align_x = align_x,
                                                     .align_y = align_y});
      const Window box = Bounds(kWidth, kHeight, [&](size_t i) { return rgb8[3 * i] != 128; });
      REQUIRE_FALSE(box.empty());
      CHECK(box.height() < 2 * kSize);
      const int x = align_x == AlignX::kLeft    ? box.x0
                    : align_x == AlignX::kRight ? box.x1
                                                : (box.x0 + box.x1) / 2;
      const int y = align_y == AlignY::kTop      ? box.y0
                    : align_y == AlignY::kBottom ? box.y1
                                                 : (box.y0 + box.y1) / 2;
      CHECK(std::abs(x - kX) <= kSlack);
      CHECK(std::abs(y - kY) <= kSlack);
    }
  }
}

TEST_CASE("labels outside the picture do no harm") {
  const std::vector<uint8_t> rgb8 = DrawOn(7, {.text = "far away", .x = 5000, .y = -5000});
  CHECK(std::ranges::count(rgb8, 7) == static_cast<ptrdiff_t>(rgb8.size()));
  CHECK_NOTHROW(DrawOn(7, {.text = "", .x = 5, .y = 5}));
  CHECK_NOTHROW(DrawOn(7, {.text = "cut by the edge", .x = 295, .y = 95}));
}

TEST_CASE("a label's buffer must be of the picture's size") {
  std::vector<uint8_t> rgb8(10);
  CHECK(Catching([&] { DrawText(rgb8, 4, 4, {}); }).code == ExitCode::kInternal);
}

TEST_CASE("a file that has gone since it was opened is an error of its own") {
  const std::string gone = "no folder/gone.exr";
  try {
    FileBytes(gone);
    FAIL();
  } catch (const Error& error) {
    CHECK(error.code() == ExitCode::kBadInput);
    CHECK(std::string(error.what()).find(gone + ": changed") != std::string::npos);
  }
}

}  // namespace
}  // namespace nacre
