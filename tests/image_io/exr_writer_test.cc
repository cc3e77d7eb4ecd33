// SPDX-License-Identifier: Apache-2.0
// tests/image_io/exr_writer_test.cc: EXR files, read back by OpenEXR.
#include "image_io/exr_writer.h"

#include <cmath>
#include <limits>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>

#include "pictures.h"
#include "targets.h"

namespace nacre {
namespace {

const std::vector<ExrOptions> kLossless = {{.compression = Compression::kNone},
                                           {.compression = Compression::kZip},
                                           {.compression = Compression::kZips},
                                           {.compression = Compression::kPiz},
                                           {.compression = Compression::kZip, .small = true},
                                           {.compression = Compression::kZips, .small = true}};

TEST_CASE("files of all sizes and lossless compressions read back identical") {
  const TestFolder folder;
  const std::vector<std::pair<int, int>> sizes = {{1, 1},   {17, 33}, {1920, 17},
                                                  {3, 200}, {64, 16}, {2, 32}};
  for (const auto& [width, height] : sizes) {
    const Picture picture = MakePicture(width, height);
    for (const ExrOptions& options : kLossless) {
      CAPTURE(width, height, static_cast<int>(options.compression), options.small);
      WritePicture(folder / "a.exr", picture, options);
      CheckSamePicture(ReadExr(folder / "a.exr"), picture);
    }
  }
}

TEST_CASE("crops read back identical, windows too") {
  const TestFolder folder;
  const std::vector<std::pair<Window, Window>> windows = {
      {{5, 7, 42, 60}, {0, 0, 64, 64}},      // inside
      {{-5, -37, 12, 3}, {0, 0, 64, 64}},    // across the corner
      {{10, 32, 11, 80}, {8, 16, 40, 100}},  // display not at the origin
      {{100, 100, 120, 117}, {0, 0, 8, 8}}};
  for (const auto& [data, display] : windows) {
    const Picture picture = MakePicture(data, display, MixedChannels());
    for (const ExrOptions& options : kLossless) {
      CAPTURE(data.x0, data.y0, static_cast<int>(options.compression));
      WritePicture(folder / "a.exr", picture, options);
      CheckSamePicture(ReadExr(folder / "a.exr"), picture);
    }
  }
}

TEST_CASE("one channel of each type reads back identical") {
  const TestFolder folder;
  for (const PixelType type : {PixelType::kHalf, PixelType::kFloat, PixelType::kUint}) {
    const Window window = {0, 0, 37, 41};
    const Picture picture = MakePicture(window, window, {{"Y", type}});
    for (const ExrOptions& options : kLossless) {
      CAPTURE(static_cast<int>(type), static_cast<int>(options.compression));
      WritePicture(folder / "a.exr", picture, options);
      CheckSamePicture(ReadExr(folder / "a.exr"), picture);
    }
  }
}

// Bits that no compression shortens: chunks are stored as they are.
TEST_CASE("noise reads back identical") {
  const TestFolder folder;
  const Window window = {0, 0, 50, 50};
  Picture picture = MakePicture(window, window, {{"R", PixelType::kFloat}});
  std::mt19937 random(5);
  for (float& sample : picture.floats[0]) {
    sample = std::bit_cast<float>(static_cast<uint32_t>(random() % 0x7f000000u));
  }
  for (const ExrOptions& options : kLossless) {
    CAPTURE(static_cast<int>(options.compression), options.small);
    WritePicture(folder / "a.exr", picture, options);
    CheckSamePicture(ReadExr(folder / "a.exr"), picture);
  }
}

// Writes the picture with OpenEXR alone.
void WriteByLibrary(const std::string& path, const Picture& picture, Imf::Compression compression) {
  const Window& data = picture.header.data;
  Imf::Header header(data.width(), data.height());
  header.compression() = compression;
  std::vector<std::vector<Imath::half>> halves(picture.floats.size());
  Imf::FrameBuffer frame;
  const auto width = static_cast<size_t>(data.width());
  for (size_t c = 0; c < picture.floats.size(); ++c) {
    const ExrChannel& channel = picture.header.channels[c];
    const std::vector<float>& samples = picture.floats[c];
    const void* place = samples.data();
    Imf::PixelType type = Imf::FLOAT;
    if (channel.type == PixelType::kHalf) {
      halves[c].assign(samples.begin(), samples.end());
      place = halves[c].data();
      type = Imf::HALF;
    } else if (channel.type == PixelType::kUint) {
      place = picture.ids[c].data();
      type = Imf::UINT;
    }
    const size_t bytes = type == Imf::HALF ? 2 : 4;
    header.channels().insert(channel.name, Imf::Channel(type));
    frame.insert(channel.name, Imf::Slice(type, static_cast<char*>(const_cast<void*>(place)), bytes,
                                          bytes * width));
  }
  Imf::OutputFile file(path.c_str(), header, 0);
  file.setFrameBuffer(frame);
  file.writePixels(data.height());
}

// DWAA loses something: exactly what it loses in OpenEXR's hands.
TEST_CASE("DWAA holds what OpenEXR makes of it") {
  const TestFolder folder;
  for (const auto& [width, height] : std::vector<std::pair<int, int>>{{1, 1}, {70, 100}}) {
    const Picture picture = MakePicture(width, height);
    WriteByLibrary(folder / "library.exr", picture, Imf::DWAA_COMPRESSION);
    WritePicture(folder / "ours.exr", picture, {.compression = Compression::kDwaa});
    const Image library = ReadExr(folder / "library.exr");
    const Image ours = ReadExr(folder / "ours.exr");
    CHECK(ours.metadata.at("compression") == "dwaa");
    for (const Channel& channel : library.channels) {
      CAPTURE(channel.name);
      REQUIRE(ours.Find(channel.name) != nullptr);
      CHECK(ours.Find(channel.name)->samples == channel.samples);
    }
  }
}

TEST_CASE("a file's bytes depend neither on the order of strips nor on the target") {
  const TestFolder folder;
  const Picture picture = MakePicture(100, 150);
  for (const ExrOptions& options : kLossless) {
    CAPTURE(static_cast<int>(options.compression), options.small);
    {
      ExrWriter writer(folder / "in_order.exr", picture.header, options);
      for (size_t i = 0; i < StripCount(picture); ++i) writer.WriteStrip(ViewStrip(picture, i));
      writer.Finish();
    }
    const std::vector<uint8_t> expected = ReadBytes(folder / "in_order.exr");
    ForEachTarget([&](Target) {
      WritePicture(folder / "shuffled.exr", picture, options);
      CHECK(ReadBytes(folder / "shuffled.exr") == expected);
    });
    std::vector<uint8_t> in_memory;
    ExrWriter writer(&in_memory, picture.header, options);
    for (size_t i = 0; i < StripCount(picture); ++i) writer.WriteStrip(ViewStrip(picture, i));
    writer.Finish();
    CHECK(in_memory == expected);
  }
}

TEST_CASE("the header says what it was told") {
  const TestFolder folder;
  Picture picture = MakePicture(20, 20);
  Imath::M44f matrix;
  for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = static_cast<float>(i) + 0.5f;
  const std::string long_key = "nacre:a key of more than thirty-one characters";
  picture.header.world_to_camera = matrix;
  picture.header.world_to_ndc = matrix.transposed();
  picture.header.attributes = {{"Software", "nacre 0.1"},      {"nacre:samples", 64},
                               {"nacre:renderSeconds", 0.f},   {"nacre:strips", 0},
                               {"nacre:scene", "caf\xc3\xa9"}, {long_key, ""}};
  ExrWriter writer(folder / "a.exr", picture.header);
  for (size_t i = 0; i < StripCount(picture); ++i) writer.WriteStrip(ViewStrip(picture, i));
  writer.UpdateAttribute("nacre:renderSeconds", 1.25f);
  writer.UpdateAttribute("nacre:strips", -2);
  const auto update = [&](const std::string& name, const ExrAttribute& value) {
    return Catching([&] { writer.UpdateAttribute(name, value); }).code;
  };
  CHECK(update("nacre:strips", 1.0f) == ExitCode::kInternal);  // another type
  CHECK(update("strips", 1) == ExitCode::kInternal);           // the end of a name
  CHECK(update("Software", "x") == ExitCode::kInternal);       // not a number
  CHECK(update("nacre:absent", 1) == ExitCode::kInternal);
  writer.Finish();

  const Image image = ReadExr(folder / "a.exr");
  CheckSamePicture(image, picture);
  CHECK(image.metadata.at("Software") == "nacre 0.1");
  CHECK(image.metadata.at("nacre:samples") == "64");
  CHECK(image.metadata.at("nacre:renderSeconds") == "1.25");
  CHECK(image.metadata.at("nacre:strips") == "-2");
  CHECK(image.metadata.at("nacre:scene") == "caf\xc3\xa9");
  CHECK(image.metadata.at(long_key).empty());
  CHECK(image.metadata.at("compression") == "zip");
  CHECK(image.metadata.at("lineOrder") == "increasing y");

  const Imf::InputFile file((folder / "a.exr").c_str());
  CHECK(Imf::worldToCamera(file.header()) == matrix);
  CHECK(Imf::worldToNDC(file.header()) == matrix.transposed());
  // The library's defaults are Rec. 709's.
  CHECK(Imf::chromaticities(file.header()) == Imf::Chromaticities());
}

TEST_CASE("samples that a file cannot hold are counted") {
  const TestFolder folder;
  const Window window = {0, 0, 10, 20};
  Picture picture =
      MakePicture(window, window, {{"R", PixelType::kHalf}, {"Z", PixelType::kFloat}});
  const float infinity = std::numeric_limits<float>::infinity();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (std::vector<float>& floats : picture.floats) {
    floats[3] = 1e9f;
    floats[177] = -70000.0f;
    floats[40] = nan;
    floats[199] = -infinity;
  }
  ExrWriter writer(folder / "a.exr", picture.header);
  ShuffledInThreads(2, [&](size_t i) { writer.WriteStrip(ViewStrip(picture, i)); });
  writer.Finish();
  CHECK(writer.counts().clamped == 2);   // in the half channel
  CHECK(writer.counts().nan == 2);       // in both
  CHECK(writer.counts().infinite == 2);  // in both
  const Image image = ReadExr(folder / "a.exr");
  const std::vector<float>& halves = image.Find("R")->samples;
  CHECK(halves[3] == 65504.0f);
  CHECK(halves[177] == -65504.0f);
  CHECK(std::isnan(halves[40]));
  CHECK(halves[199] == -65504.0f);
  const std::vector<float>& floats = image.Find("Z")->samples;
  CHECK(floats[3] == 1e9f);
  CHECK(floats[177] == -70000.0f);
  CHECK(std::isnan(floats[40]));
  CHECK(floats[199] == -infinity);
}

TEST_CASE("ids given as floats") {
  const TestFolder folder;
  const Window window = {0, 0, 3, 2};
  ExrHeader header;
  header.data = header.display = window;
  header.channels = {{"id.object", PixelType::kUint}};
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<float> ids = {0.0f, 16777216.0f, 7.9f, -3.0f, 1e20f, nan};
  ExrWriter writer(folder / "a.exr", header);
  writer.WriteStrip({0, 2, {ids.data()}});
  writer.Finish();
  const std::vector<float> expected = {0.0f, 16777216.0f, 7.0f, 0.0f, 4294967295.0f, 0.0f};
  CHECK(ReadExr(folder / "a.exr").Find("id.object")->samples == expected);
}

TEST_CASE("a writer called wrongly says so") {
  const TestFolder folder;
  const Picture picture = MakePicture(10, 40);
  const auto open = [&](const std::vector<ExrChannel>& channels) {
    ExrHeader header = picture.header;
    header.channels = channels;
    return Catching([&] { const ExrWriter writer(folder / "a.exr", header); }).code;
  };
  CHECK(open({}) == ExitCode::kInternal);
  CHECK(open({{"", PixelType::kHalf}}) == ExitCode::kInternal);
  CHECK(open({{"R", PixelType::kHalf}, {"R", PixelType::kFloat}}) == ExitCode::kInternal);
  ExrHeader wide = picture.header;
  wide.data = {0, 0, 1 << 28, 1};
  CHECK(Catching([&] { const ExrWriter writer(folder / "a.exr", wide); }).code ==
        ExitCode::kInternal);

  for (const Compression compression : {Compression::kZip, Compression::kPiz}) {
    ExrWriter writer(folder / "a.exr", picture.header, {.compression = compression});
    const auto write = [&](int y, int rows, size_t channels) {
      StripView strip = ViewStrip(picture, 0);
      strip.y = y;
      strip.rows = rows;
      strip.channels.resize(channels);
      return Catching([&] { writer.WriteStrip(strip); }).code;
    };
    const size_t count = picture.header.channels.size();
    CHECK(write(8, 16, count) == ExitCode::kInternal);
    CHECK(write(-16, 16, count) == ExitCode::kInternal);
    CHECK(write(48, 16, count) == ExitCode::kInternal);
    CHECK(write(32, 16, count) == ExitCode::kInternal);
    CHECK(write(0, 16, count - 1) == ExitCode::kInternal);
    CHECK(write(0, 16, count) == ExitCode::kOk);
    CHECK(write(0, 16, count) == ExitCode::kInternal);                      // twice
    CHECK(Catching([&] { writer.Finish(); }).code == ExitCode::kInternal);  // incomplete
  }
  CHECK(folder.file_count() == 0);
}

}  // namespace
}  // namespace nacre
