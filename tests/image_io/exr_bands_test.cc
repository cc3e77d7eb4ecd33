// SPDX-License-Identifier: Apache-2.0
// tests/image_io/exr_bands_test.cc: bands of a picture, put together without decoding them.
#include "image_io/exr_bands.h"

#include <algorithm>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>

#include "base/error.h"
#include "image_io/exr_container.h"
#include "pictures.h"

namespace nacre {
namespace {

const std::vector<Compression> kCompressions = {Compression::kNone, Compression::kZip,
                                                Compression::kZips, Compression::kPiz,
                                                Compression::kDwaa};

// Rows y0 .. y1 - 1 of a picture, in the same display window.
Picture CutRows(const Picture& picture, int y0, int y1) {
  Picture part;
  part.header = picture.header;
  part.header.data.y0 = y0;
  part.header.data.y1 = y1;
  const auto width = static_cast<ptrdiff_t>(picture.header.data.width());
  const ptrdiff_t first = (y0 - picture.header.data.y0) * width;
  const ptrdiff_t end = (y1 - picture.header.data.y0) * width;
  for (const auto& plane : picture.floats) {
    part.floats.emplace_back(plane.begin() + first, plane.begin() + end);
  }
  for (const auto& plane : picture.ids) {
    part.ids.emplace_back();
    if (!plane.empty()) part.ids.back().assign(plane.begin() + first, plane.begin() + end);
  }
  return part;
}

Picture MakeDescribedPicture(const Window& window) {
  Picture picture = MakePicture(window, window, MixedChannels());
  picture.header.world_to_camera =
      Imath::M44f(1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16);
  picture.header.attributes = {{"a number", 7}, {"nacre:real", 0.25f}, {"text", std::string("t")}};
  return picture;
}

TEST_CASE("bands put together are the whole picture's file, to the byte") {
  const TestFolder folder;
  // A display window that does not begin at 0: chunks count from the data window's top.
  const Picture picture = MakeDescribedPicture({-3, 5, 40, 5 + 109});
  for (const Compression compression : kCompressions) {
    CAPTURE(static_cast<int>(compression));
    const ExrOptions options{.compression = compression};
    WritePicture(folder / "whole.exr", picture, options);
    ExrBandHeader header = ExrBandReader(folder / "whole.exr").ReadHeader();
    CHECK(header.compression == compression);
    CHECK(header.header.data == picture.header.data);
    CHECK(header.header.attributes == picture.header.attributes);
    ExrContainer writer(folder / "merged.exr", nullptr, header.header, header.compression);
    for (const auto& [y0, y1] : {std::pair{5, 37}, std::pair{37, 101}, std::pair{101, 114}}) {
      WritePicture(folder / "band.exr", CutRows(picture, y0, y1), options);
      ExrBandReader band(folder / "band.exr");
      for (int y = y0; y < y1; y += RowsPerChunk(compression)) {
        writer.WriteChunk(y, band.ReadChunk(y));
      }
    }
    writer.Finish(/*sync=*/true);
    CHECK(ReadBytes(folder / "merged.exr") == ReadBytes(folder / "whole.exr"));
  }
}

TEST_CASE("rows of a band are its samples") {
  const TestFolder folder;
  const Picture picture = MakePicture(23, 50);
  WritePicture(folder / "a.exr", picture, {.compression = Compression::kPiz});
  ExrBandReader reader(folder / "a.exr");
  std::vector<std::vector<float>> planes;
  reader.ReadRows(30, 9, {"Z", "N.X"}, &planes);
  for (const auto& [plane, channel] : {std::pair{0, 5}, std::pair{1, 7}}) {
    const std::vector<float>& whole = picture.floats[static_cast<size_t>(channel)];
    const std::vector<float>& rows = planes[static_cast<size_t>(plane)];
    REQUIRE(rows.size() == size_t{9} * 23);
    CHECK(std::equal(rows.begin(), rows.end(), whole.begin() + ptrdiff_t{30} * 23));
  }
}

void WriteForeign(const std::string& path, Imf::LineOrder order, Imf::Compression compression) {
  Imf::Header header(4, 4, 1.0f, Imath::V2f(0), 1.0f, order, compression);
  header.channels().insert("R", Imf::Channel(Imf::FLOAT));
  std::vector<float> samples(16);
  Imf::FrameBuffer frame;
  frame.insert("R", Imf::Slice::Make(Imf::FLOAT, samples.data(), Imath::V2i(0), 4, 4));
  Imf::OutputFile file(path.c_str(), header);
  file.setFrameBuffer(frame);
  file.writePixels(4);
}

TEST_CASE("files that ExrWriter does not write, and broken ones, are refused") {
  const TestFolder folder;
  CHECK_THROWS_AS(ExrBandReader(folder / "missing.exr"), Error);
  CHECK_THROWS_AS(ExrBandReader(folder.path()), Error);
  WriteForeign(folder / "up.exr", Imf::DECREASING_Y, Imf::ZIP_COMPRESSION);
  CHECK_THROWS_AS(ExrBandReader(folder / "up.exr"), Error);
  WriteForeign(folder / "b44.exr", Imf::INCREASING_Y, Imf::B44_COMPRESSION);
  CHECK_THROWS_AS(ExrBandReader(folder / "b44.exr").ReadHeader(), Error);
  WriteForeign(folder / "fine.exr", Imf::INCREASING_Y, Imf::ZIP_COMPRESSION);
  CHECK(ExrBandReader(folder / "fine.exr").ReadHeader().header.channels.size() == 1);
  CHECK_THROWS_AS(ExrBandReader(folder / "fine.exr").ReadChunk(16), Error);
}

}  // namespace
}  // namespace nacre
