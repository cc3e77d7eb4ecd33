// SPDX-License-Identifier: Apache-2.0
// tests/image_io/png_writer_test.cc: PNG files, taken apart by the specification and read back by
// OpenImageIO.
#include "image_io/png_writer.h"

#include <cmath>

#include <zlib.h>

#include "files.h"
#include "image_io/read_image.h"

namespace nacre {
namespace {

std::vector<uint8_t> MakePixels(int width, int height, bool noise) {
  std::vector<uint8_t> pixels;
  std::mt19937 random(11);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < 3; ++c) {
        pixels.push_back(
            static_cast<uint8_t>(noise ? static_cast<int>(random() % 256) : (x * (c + 1) + y) / 3));
      }
    }
  }
  return pixels;
}

void WritePng(const std::string& path, const PngHeader& header, const std::vector<uint8_t>& pixels,
              const PngOptions& options, const PngText& late_text = {}) {
  PngWriter writer(path, header, options);
  const auto row_bytes = 3 * static_cast<size_t>(header.width);
  const auto strips = static_cast<size_t>((header.height + 15) / 16);
  ShuffledInThreads(strips, [&](size_t i) {
    const int y = 16 * static_cast<int>(i);
    writer.WriteStrip(y, std::min(16, header.height - y),
                      &pixels[static_cast<size_t>(y) * row_bytes]);
  });
  writer.Finish(late_text);
}

struct PngChunk {
  std::string type;
  std::vector<uint8_t> content;
};

uint32_t BigEndian(const uint8_t* bytes) {
  return (uint32_t{bytes[0]} << 24) | (uint32_t{bytes[1]} << 16) | (uint32_t{bytes[2]} << 8) |
         bytes[3];
}

// The file's chunks; checks the signature and every checksum.
std::vector<PngChunk> TakeApart(const std::vector<uint8_t>& file) {
  const std::vector<uint8_t> signature = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  REQUIRE(std::equal(signature.begin(), signature.end(), file.begin()));
  std::vector<PngChunk> chunks;
  size_t place = signature.size();
  while (place < file.size()) {
    REQUIRE(place + 12 <= file.size());
    const size_t length = BigEndian(&file[place]);
    REQUIRE(place + 12 + length <= file.size());
    const uint8_t* type = &file[place + 4];
    CHECK(crc32(0, type, static_cast<uInt>(4 + length)) == BigEndian(type + 4 + length));
    chunks.push_back({{type, type + 4}, {type + 4, type + 4 + length}});
    place += 12 + length;
  }
  return chunks;
}

// The rows before deflate, each after its filter type. uncompress checks the Adler sum.
std::vector<uint8_t> Inflate(const std::vector<PngChunk>& chunks, size_t size) {
  std::vector<uint8_t> stream;
  for (const PngChunk& chunk : chunks) {
    if (chunk.type == "IDAT") {
      stream.insert(stream.end(), chunk.content.begin(), chunk.content.end());
    }
  }
  std::vector<uint8_t> rows(size);
  uLongf inflated = size;
  CHECK(uncompress(rows.data(), &inflated, stream.data(), stream.size()) == Z_OK);
  CHECK(inflated == size);
  return rows;
}

TEST_CASE("PNG files of all sizes read back identical") {
  const TestFolder folder;
  for (const auto& [width, height] : std::vector<std::pair<int, int>>{
           {1, 1}, {17, 33}, {1920, 17}, {3, 200}, {64, 16}, {2, 32}, {1, 15}}) {
    for (const bool noise : {false, true}) {
      for (const bool small : {false, true}) {
        CAPTURE(width, height, noise, small);
        const std::vector<uint8_t> pixels = MakePixels(width, height, noise);
        WritePng(folder / "a.png", {width, height, {}}, pixels, {.small = small});
        const Image image = ReadImage(folder / "a.png");
        CHECK(image.data == Window{0, 0, width, height});
        CHECK(image.metadata.at("transfer") == "display");
        REQUIRE(image.channels.size() == 3);
        std::vector<uint8_t> read;
        for (size_t i = 0; i < image.data.pixel_count(); ++i) {
          for (const char* name : {"R", "G", "B"}) {
            read.push_back(static_cast<uint8_t>(std::lround(255 * image.Find(name)->samples[i])));
          }
        }
        CHECK(read == pixels);
      }
    }
  }
}

TEST_CASE("the chunks of a PNG are those of the specification") {
  const TestFolder folder;
  constexpr int kWidth = 50, kHeight = 40;
  const std::vector<uint8_t> pixels = MakePixels(kWidth, kHeight, false);
  const PngText text = {{"Software", "nacre"}, {"Title", "caf\xc3\xa9"}};
  WritePng(folder / "a.png", {kWidth, kHeight, text}, pixels, {}, {{"Comment", "3 ms"}});
  const std::vector<PngChunk> chunks = TakeApart(ReadBytes(folder / "a.png"));
  std::string types;
  for (const PngChunk& chunk : chunks) types += chunk.type + " ";
  // Three strips, and the stream's checksum.
  CHECK(types == "IHDR sRGB gAMA cHRM tEXt iTXt IDAT IDAT IDAT IDAT tEXt IEND ");
  CHECK(chunks[0].content ==
        std::vector<uint8_t>{0, 0, 0, kWidth, 0, 0, 0, kHeight, 8, 2, 0, 0, 0});
  CHECK(chunks[1].content == std::vector<uint8_t>{0});
  CHECK(BigEndian(chunks[2].content.data()) == 45455);
  const auto content = [&](size_t i) {
    return std::string(chunks[i].content.begin(), chunks[i].content.end());
  };
  CHECK(content(4) == std::string("Software\0nacre", 14));
  CHECK(content(5) == std::string("Title\0\0\0\0\0caf\xc3\xa9", 15));
  CHECK(content(10) == std::string("Comment\0003 ms", 12));

  const size_t row_bytes = 3 * kWidth;
  std::vector<uint8_t> rows = Inflate(chunks, (1 + row_bytes) * kHeight);
  for (size_t y = 0; y < kHeight; ++y) {
    const uint8_t* row = &rows[y * (1 + row_bytes)];
    REQUIRE(row[0] == (y % 16 == 0 ? 1 : 2));  // Sub: no strip needs another; Up
    for (size_t i = 0; i < row_bytes; ++i) {
      const size_t here = y * row_bytes + i;
      const uint8_t left = i < 3 ? uint8_t{0} : pixels[here - 3];
      const uint8_t predicted = y % 16 == 0 ? left : pixels[here - row_bytes];
      REQUIRE(static_cast<uint8_t>(row[1 + i] + predicted) == pixels[here]);
    }
  }
}

TEST_CASE("a PNG's bytes do not depend on the order of strips") {
  const TestFolder folder;
  const PngHeader header = {30, 70, {}};
  const std::vector<uint8_t> pixels = MakePixels(header.width, header.height, false);
  WritePng(folder / "shuffled.png", header, pixels, {});
  PngWriter writer(folder / "in_order.png", header);
  for (int y = 0; y < header.height; y += 16) {
    writer.WriteStrip(y, std::min(16, header.height - y), &pixels[static_cast<size_t>(y) * 90]);
  }
  writer.Finish();
  CHECK(ReadBytes(folder / "in_order.png") == ReadBytes(folder / "shuffled.png"));
}

TEST_CASE("small PNGs are smaller") {
  const TestFolder folder;
  const PngHeader header = {300, 300, {}};
  const std::vector<uint8_t> pixels = MakePixels(header.width, header.height, false);
  WritePng(folder / "fast.png", header, pixels, {});
  WritePng(folder / "small.png", header, pixels, {.small = true});
  CHECK(std::filesystem::file_size(folder / "small.png") <
        std::filesystem::file_size(folder / "fast.png"));
}

TEST_CASE("a PNG writer called wrongly says so") {
  const TestFolder folder;
  const auto open = [&](int width, int height) {
    return Catching([&] { const PngWriter writer(folder / "a.png", {width, height, {}}); }).code;
  };
  CHECK(open(0, 1) == ExitCode::kInternal);
  CHECK(open(1, 0) == ExitCode::kInternal);
  CHECK(open(1 << 30, 1) == ExitCode::kInternal);
  const std::vector<uint8_t> pixels(3 * 4 * 20);
  PngWriter writer(folder / "a.png", {4, 20, {}});
  const auto write = [&](int y, int rows) {
    return Catching([&] { writer.WriteStrip(y, rows, pixels.data()); }).code;
  };
  CHECK(write(8, 12) == ExitCode::kInternal);
  CHECK(write(16, 16) == ExitCode::kInternal);
  CHECK(write(-16, 16) == ExitCode::kInternal);
  CHECK(write(0, 16) == ExitCode::kOk);
  CHECK(write(0, 16) == ExitCode::kInternal);
  CHECK(Catching([&] { writer.Finish(); }).code == ExitCode::kInternal);
  CHECK(folder.file_count() == 0);
}

}  // namespace
}  // namespace nacre
