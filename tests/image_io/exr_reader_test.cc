// SPDX-License-Identifier: Apache-2.0
// tests/image_io/exr_reader_test.cc: EXR files of other makers, and broken ones.
#include <cstring>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfTileDescription.h>
#include <OpenEXR/ImfTiledOutputFile.h>
#include <OpenEXR/ImfVecAttribute.h>

#include "image_io/color_channels.h"
#include "image_io/format_readers.h"
#include "image_io/read_image.h"
#include "pictures.h"

namespace nacre {
namespace {

constexpr int kWidth = 50, kHeight = 37;

std::vector<float> Ramp(float start) {
  std::vector<float> samples(kWidth * kHeight);
  for (size_t i = 0; i < samples.size(); ++i) samples[i] = start + static_cast<float>(i);
  return samples;
}

Imf::FrameBuffer FrameOf(std::vector<float>& samples) {
  Imf::FrameBuffer frame;
  frame.insert("Y", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(samples.data()), 4, 4 * kWidth));
  return frame;
}

Imf::Header HeaderOf() {
  Imf::Header header(kWidth, kHeight);
  header.channels().insert("Y", Imf::Channel(Imf::FLOAT));
  return header;
}

TEST_CASE("tiled files, also with mipmaps") {
  const TestFolder folder;
  for (const Imf::LevelMode mode : {Imf::ONE_LEVEL, Imf::MIPMAP_LEVELS}) {
    std::vector<float> samples = Ramp(0);
    Imf::Header header = HeaderOf();
    header.setTileDescription(Imf::TileDescription(16, 8, mode));
    {
      Imf::TiledOutputFile file((folder / "a.exr").c_str(), header);
      file.setFrameBuffer(FrameOf(samples));
      for (int level = 0; level < file.numLevels(); ++level) {
        file.writeTiles(0, file.numXTiles(level) - 1, 0, file.numYTiles(level) - 1, level);
      }
    }
    const Image image = ReadExr(folder / "a.exr");
    REQUIRE(image.channels.size() == 1);
    CHECK(image.channels[0].name == "Y");
    CHECK(image.channels[0].type == PixelType::kFloat);
    CHECK(image.channels[0].samples == samples);
  }
}

TEST_CASE("all parts are read, under their names, or one of them") {
  const TestFolder folder;
  std::vector<std::vector<float>> samples = {Ramp(0), Ramp(1e4f)};
  std::vector<Imf::Header> headers(2, HeaderOf());
  for (size_t i = 0; i < 2; ++i) {
    headers[i].setName(i == 0 ? "first" : "second");
    headers[i].setType(Imf::SCANLINEIMAGE);
  }
  {
    Imf::MultiPartOutputFile file((folder / "a.exr").c_str(), headers.data(), 2);
    for (int i = 0; i < 2; ++i) {
      Imf::OutputPart part(file, i);
      part.setFrameBuffer(FrameOf(samples[static_cast<size_t>(i)]));
      part.writePixels(kHeight);
    }
  }
  const Image image = ReadImage(folder / "a.exr");
  REQUIRE(image.channels.size() == 2);
  CHECK(image.Find("first.Y")->samples == samples[0]);
  CHECK(image.Find("second.Y")->samples == samples[1]);
  const Image second = ReadImage(folder / "a.exr", "second");
  REQUIRE(second.channels.size() == 1);
  CHECK(second.metadata.at("name") == "second");
  CHECK(second.Find("Y")->samples == samples[1]);
  CHECK(Catching([&] { ReadImage(folder / "a.exr", "secund"); }).Says("did you mean \"second\"?"));
  CHECK(DescribeImage(folder / "a.exr").size() == 2);
}

TEST_CASE("parts whose channels would have the same name are to be chosen") {
  const TestFolder folder;
  std::vector<float> samples = Ramp(0);
  std::vector<Imf::Header> headers(2, Imf::Header(kWidth, kHeight));
  const char* const names[] = {"a", "a.b"};
  const char* const channels[] = {"b.Y", "Y"};
  for (size_t i = 0; i < 2; ++i) {
    headers[i].setName(names[i]);
    headers[i].setType(Imf::SCANLINEIMAGE);
    headers[i].channels().insert(channels[i], Imf::Channel(Imf::FLOAT));
  }
  {
    Imf::MultiPartOutputFile file((folder / "a.exr").c_str(), headers.data(), 2);
    for (int i = 0; i < 2; ++i) {
      Imf::FrameBuffer frame;
      frame.insert(channels[i],
                   Imf::Slice::Make(Imf::FLOAT, samples.data(), Imath::V2i(0, 0), kWidth, kHeight));
      Imf::OutputPart part(file, i);
      part.setFrameBuffer(frame);
      part.writePixels(kHeight);
    }
  }
  CHECK(Catching([&] { ReadImage(folder / "a.exr"); }).Says("both called \"a.b.Y\""));
  CHECK(ReadImage(folder / "a.exr", "a.b").channels.size() == 1);
}

// Any region, into any places: what textures ask for.
TEST_CASE("a region goes where it is wanted") {
  const TestFolder folder;
  std::vector<float> samples = Ramp(0);
  for (const bool tiled : {false, true}) {
    Imf::Header header = HeaderOf();
    if (tiled) {
      header.setTileDescription(Imf::TileDescription(16, 8));
      Imf::TiledOutputFile file((folder / "a.exr").c_str(), header);
      file.setFrameBuffer(FrameOf(samples));
      file.writeTiles(0, file.numXTiles() - 1, 0, file.numYTiles() - 1);
    } else {
      Imf::OutputFile file((folder / "a.exr").c_str(), header);
      file.setFrameBuffer(FrameOf(samples));
      file.writePixels(kHeight);
    }
    const Window region = {3, 19, 40, 36};
    std::vector<float> upside_down(region.pixel_count(), -1.0f);
    const ptrdiff_t width = region.width();
    const SampleTarget target = {0, upside_down.data() + (region.height() - 1) * width, 1, -width};
    OpenExr(folder / "a.exr").read(region, std::span(&target, 1));
    size_t wrong = 0;
    for (int y = region.y0; y < region.y1; ++y) {
      for (int x = region.x0; x < region.x1; ++x) {
        const auto row = static_cast<size_t>(region.y1 - 1 - y);
        const float got =
            upside_down[row * static_cast<size_t>(width) + static_cast<size_t>(x - region.x0)];
        wrong += got != samples[static_cast<size_t>(y * kWidth + x)];
      }
    }
    CHECK(wrong == 0);
  }
}

TEST_CASE("headers are read without samples") {
  const TestFolder folder;
  Imf::Header header = HeaderOf();
  header.insert("size", Imf::V2iAttribute(Imath::V2i(3, -4)));
  header.insert("note", Imf::StringAttribute("text"));
  std::vector<float> samples = Ramp(0);
  {
    Imf::OutputFile file((folder / "a.exr").c_str(), header);
    file.setFrameBuffer(FrameOf(samples));
    file.writePixels(kHeight);
  }
  const Image image = OpenExr(folder / "a.exr").header;
  CHECK(image.data == Window{0, 0, kWidth, kHeight});
  REQUIRE(image.channels.size() == 1);
  CHECK(image.channels[0].samples.empty());
  CHECK(image.metadata.at("size") == "3 -4");
  CHECK(image.metadata.at("note") == "text");
  CHECK(image.metadata.count("channels") == 0);
}

TEST_CASE("subsampled files are refused") {
  const TestFolder folder;
  Imf::Header header(kWidth, kHeight);
  header.channels().insert("RY", Imf::Channel(Imf::HALF, 2, 1));
  { const Imf::OutputFile file((folder / "a.exr").c_str(), header); }
  const Caught caught = Catching([&] { ReadExr(folder / "a.exr"); });
  CHECK(caught.code == ExitCode::kBadInput);
  CHECK(caught.Says("RY is subsampled"));
}

TEST_CASE("deep files are refused") {
  const TestFolder folder;
  Imf::Header header = HeaderOf();
  header.setName("deep");
  header.setType(Imf::DEEPSCANLINE);
  header.compression() = Imf::ZIPS_COMPRESSION;
  { const Imf::MultiPartOutputFile file((folder / "a.exr").c_str(), &header, 1); }
  const Caught caught = Catching([&] { ReadExr(folder / "a.exr"); });
  CHECK(caught.code == ExitCode::kBadInput);
  CHECK(caught.Says("deep"));
}

TEST_CASE("missing and empty files, folders and other formats are refused") {
  const TestFolder folder;
  WriteBytes(folder / "empty.exr", {});
  WriteText(folder / "text.exr", std::string(1000, 'x'));
  struct Row {
    std::string path, what;
  };
  const std::vector<Row> rows = {{folder / "absent.exr", "no such file"},
                                 {folder.path(), "not a regular file"},
                                 {"/dev/null", "not a regular file"},
                                 {folder / "empty.exr", "it is empty"},
                                 {folder / "text.exr", "cannot be read as EXR"}};
  for (const Row& row : rows) {
    CAPTURE(row.path);
    const Caught caught = Catching([&] { ReadExr(row.path); });
    CHECK(caught.code == ExitCode::kBadInput);
    CHECK(caught.Says(row.what));
    CHECK(Catching([&] { OpenExr(row.path); }).code == ExitCode::kBadInput);
  }
}

// A good file's bytes.
std::vector<uint8_t> GoodFile(const TestFolder& folder, Compression compression) {
  WritePicture(folder / "good.exr", MakePicture(40, 70), {.compression = compression});
  return ReadBytes(folder / "good.exr");
}

TEST_CASE("truncated files are refused") {
  const TestFolder folder;
  for (const Compression compression : {Compression::kNone, Compression::kZip, Compression::kPiz}) {
    const std::vector<uint8_t> good = GoodFile(folder, compression);
    for (size_t size = 0; size < good.size(); size += 1 + good.size() / 97) {
      CAPTURE(size, good.size());
      WriteBytes(folder / "cut.exr", {good.begin(), good.begin() + static_cast<ptrdiff_t>(size)});
      CHECK(Catching([&] { ReadExr(folder / "cut.exr"); }).code == ExitCode::kBadInput);
    }
  }
}

TEST_CASE("a data window larger than memory is refused") {
  const TestFolder folder;
  const std::vector<uint8_t> good = GoodFile(folder, Compression::kZip);
  const std::string key = std::string("dataWindow\0box2i\0\x10\0\0\0", 21);
  const auto found = std::search(good.begin(), good.end(), key.begin(), key.end());
  REQUIRE(found != good.end());
  for (const int last : {30000, 1 << 20, 1 << 30, std::numeric_limits<int>::max() / 2 - 1}) {
    CAPTURE(last);
    std::vector<uint8_t> bad = good;
    uint8_t* const window = &bad[static_cast<size_t>(found - good.begin()) + key.size()];
    std::memcpy(window + 8, &last, 4);
    std::memcpy(window + 12, &last, 4);
    WriteBytes(folder / "bad.exr", bad);
    CHECK(Catching([&] { ReadExr(folder / "bad.exr"); }).code == ExitCode::kBadInput);
  }
}

// Whatever is wrong, the file is read or refused: nothing else escapes.
TEST_CASE("damaged files are read or refused") {
  const TestFolder folder;
  std::mt19937 random(13);
  for (const Compression compression : {Compression::kNone, Compression::kZip, Compression::kPiz}) {
    const std::vector<uint8_t> good = GoodFile(folder, compression);
    for (int i = 0; i < 200; ++i) {
      std::vector<uint8_t> bad = good;
      // Half of the damage in the header.
      for (int k = 0; k < 3; ++k) {
        const size_t place = random() % (i % 2 == 0 ? size_t{700} : bad.size());
        bad[place] = static_cast<uint8_t>(random());
      }
      WriteBytes(folder / "bad.exr", bad);
      const ExitCode code = Catching([&] { ReadExr(folder / "bad.exr"); }).code;
      CHECK((code == ExitCode::kOk || code == ExitCode::kBadInput));
    }
  }
}

}  // namespace
}  // namespace nacre
