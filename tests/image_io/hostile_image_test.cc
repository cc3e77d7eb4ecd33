// SPDX-License-Identifier: Apache-2.0
// tests/image_io/hostile_image_test.cc: images that promise more than they hold, and formats that a
// stranger may not choose.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfTileDescription.h>
#include <OpenEXR/ImfTiledOutputFile.h>

#include "image_io/exr_bands.h"
#include "image_io/read_image.h"
#include "pictures.h"
#include "png_bytes.h"

namespace nacre {
namespace {

const std::string kDataWindow("dataWindow\0box2i\0", 17);  // an EXR file's attribute and its type

// The most memory that this process ever had, in MiB.
size_t PeakMib() {
  std::ifstream status("/proc/self/status");
  std::string word;
  size_t kib = 0;
  while (status >> word) {
    if (word == "VmHWM:") status >> kib;
  }
  return kib >> 10;
}

// What the refusal of such files may take: readers, a band of rows, compressed data. The thread
// sanitizer's manual says that programs take five to ten times their memory.
#if defined(__SANITIZE_THREAD__)
constexpr size_t kRoomMib = 5 * 200;
#else
constexpr size_t kRoomMib = 200;
#endif

// What the action's refusal says, which must be one of bad input, and take little room.
Caught RefusedInLittleRoom(const std::function<void()>& action) {
  const size_t before = PeakMib();
  const Caught caught = Catching(action);
  CHECK(caught.code == ExitCode::kBadInput);
  CHECK(PeakMib() < before + kRoomMib);
  return caught;
}

// The place in an EXR file's bytes behind an attribute's name, its type and the four bytes of its
// size.
std::vector<uint8_t>::iterator ValueOf(const std::string& name_and_type,
                                       std::vector<uint8_t>* file) {
  const auto found =
      std::search(file->begin(), file->end(), name_and_type.begin(), name_and_type.end());
  REQUIRE(found != file->end());
  return found + static_cast<std::ptrdiff_t>(name_and_type.size()) + 4;
}

// An RGB file of 8 bits that holds `bytes` zeros, compressed.
std::vector<uint8_t> Png(uint32_t width, uint32_t height, size_t bytes) {
  std::vector<uint8_t> file = PngHead(width, height, 8, 2);
  AppendPixels(std::vector<uint8_t>(bytes), &file);
  return file;
}

TEST_CASE("a PNG that promises more than deflate can hold costs nothing") {
  const TestFolder folder;
  // As many zeros as the picture has: read, however well it is compressed.
  WriteBytes(folder / "whole.png", Png(2000, 1000, 1000 * (3 * 2000 + 1)));
  CHECK(ReadImage(folder / "whole.png").channels.size() == 3);
  WriteBytes(folder / "bomb.png", Png(20'000, 8000, 1000));  // 0.5 GB
  const Caught caught = RefusedInLittleRoom([&] { ReadImage(folder / "bomb.png"); });
  CHECK(caught.Says("cannot hold its 20000 x 8000 pixels"));  // before any of them is read
}

TEST_CASE("an EXR whose header promises pixels that are not there costs nothing") {
  const TestFolder folder;
  WritePicture(folder / "a.exr", MakePicture(8, 8), {});
  std::vector<uint8_t> file = ReadBytes(folder / "a.exr");
  // x0, y0, x1, y1, little-endian.
  const auto corner = ValueOf(kDataWindow, &file) + 8;
  const std::vector<uint8_t> far = {0xff, 0x1f, 0, 0, 0xff, 0x0f, 0, 0};  // 8192 x 4096
  std::copy(far.begin(), far.end(), corner);
  file.resize(file.size() + (1 << 16));  // room for the table of its chunks, which it must have
  WriteBytes(folder / "bomb.exr", file);
  CHECK(OpenExr(folder / "bomb.exr").header.data.width() == 8192);
  CHECK(RefusedInLittleRoom([&] { ReadExr(folder / "bomb.exr"); }).Says("bomb.exr"));
}

TEST_CASE("an EXR with tiles far larger than its picture takes no room") {
  const TestFolder folder;
  Imf::Header header(8, 8);
  header.channels().insert("R", Imf::Channel(Imf::FLOAT));
  header.setTileDescription(Imf::TileDescription(4, 4));
  std::vector<float> red(64, 0.5f);
  Imf::FrameBuffer frame;
  frame.insert("R", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(red.data()), 4, 32));
  {
    Imf::TiledOutputFile file((folder / "a.exr").c_str(), header);
    file.setFrameBuffer(frame);
    file.writeTiles(0, 1, 0, 1);
  }
  CHECK(ReadExr(folder / "a.exr").channels.at(0).samples == red);
  std::vector<uint8_t> file = ReadBytes(folder / "a.exr");
  // Width and height, little-endian.
  const auto tile = ValueOf(std::string("tiles\0tiledesc\0", 15), &file);
  const auto refused = [&](const std::vector<uint8_t>& size) {
    std::copy(size.begin(), size.end(), tile);
    WriteBytes(folder / "huge.exr", file);
    return RefusedInLittleRoom([&] { ReadExr(folder / "huge.exr"); });
  };
  CHECK(refused({8, 0, 0, 0, 0, 0, 0, 0x10}).Says("tiles: 8 x 268435456 pixels of 1 channels"));
  CHECK(refused({0, 0, 0, 0x10, 8, 0, 0, 0}).Says("tiles: 268435456 x 8 pixels of 1 channels"));
}

// An EXR file of one ZIP chunk, without nacre's checksum, whose compressed bytes are `packed`.
void WriteOneChunk(const std::string& path, const std::vector<uint8_t>& packed) {
  constexpr int kWidth = 64, kRows = 16;
  {
    Imf::Header header(kWidth, kRows);
    header.compression() = Imf::ZIP_COMPRESSION;
    header.channels().insert("Y", Imf::Channel(Imf::FLOAT));
    std::vector<float> samples(size_t{kWidth} * kRows, 0.25f);
    Imf::FrameBuffer frame;
    frame.insert("Y",
                 Imf::Slice::Make(Imf::FLOAT, samples.data(), Imath::V2i(0, 0), kWidth, kRows));
    Imf::OutputFile file(path.c_str(), header);
    file.setFrameBuffer(frame);
    file.writePixels(kRows);
  }
  std::vector<uint8_t> bytes = ReadBytes(path);
  // The table of chunks has one entry, which tells where it ends itself: row and size follow.
  const auto entry_at = [&](size_t at) {
    uint64_t offset = 0;
    for (size_t k = 0; k < 8; ++k) offset |= uint64_t{bytes[at + k]} << 8 * k;
    return offset;
  };
  size_t table = 0;
  while (entry_at(table) != table + 8) ++table;
  bytes.resize(table + 8 + 8);
  for (size_t k = 0; k < 4; ++k) {
    bytes[table + 8 + 4 + k] = static_cast<uint8_t>(packed.size() >> 8 * k);
  }
  bytes.insert(bytes.end(), packed.begin(), packed.end());
  WriteBytes(path, bytes);
}

std::vector<uint8_t> Deflated(size_t zeros) {
  const std::vector<uint8_t> bytes(zeros);
  std::vector<uint8_t> packed(compressBound(zeros));
  uLongf size = packed.size();
  compress2(packed.data(), &size, bytes.data(), zeros, 9);
  packed.resize(size);
  return packed;
}

TEST_CASE("chunks that inflate to too little or too much are damage, for whoever verifies") {
  const TestFolder folder;
  constexpr size_t kBytes = size_t{64} * 16 * 4;
  WriteOneChunk(folder / "good.exr", Deflated(kBytes));
  CHECK_NOTHROW(VerifyImage(folder / "good.exr"));
  CHECK_NOTHROW(ExrBandReader(folder / "good.exr").DecodeAll());
  std::vector<uint8_t> cut = Deflated(kBytes);
  cut.pop_back();
  for (const std::vector<uint8_t>& packed :
       {Deflated(kBytes / 2), Deflated(0), Deflated(kBytes - 1), Deflated(kBytes + 4), cut}) {
    CAPTURE(packed.size());
    WriteOneChunk(folder / "bad.exr", packed);
    CHECK(Catching([&] { VerifyImage(folder / "bad.exr"); }).code == ExitCode::kBadInput);
    CHECK(Catching([&] { ExrBandReader(folder / "bad.exr").DecodeAll(); }).code ==
          ExitCode::kBadInput);
    CHECK(Catching([&] { ReadExr(folder / "bad.exr"); }).code == ExitCode::kBadInput);
  }
}

TEST_CASE("rows that the file has no bytes for take no room where they are verified") {
  const TestFolder folder;
  WriteOneChunk(folder / "a.exr", Deflated(size_t{64} * 16 * 4));
  std::vector<uint8_t> file = ReadBytes(folder / "a.exr");
  const std::vector<uint8_t> far = {0x7f, 0xf0, 0xfa, 0x02};  // 50 million
  std::copy(far.begin(), far.end(), ValueOf(kDataWindow, &file) + 8);
  WriteBytes(folder / "wide.exr", file);
  RefusedInLittleRoom([&] { VerifyImage(folder / "wide.exr"); });
  RefusedInLittleRoom([&] { ExrBandReader(folder / "wide.exr").DecodeAll(); });
}

TEST_CASE("a JPEG that promises more than it holds costs nothing") {
  const TestFolder folder;
  std::vector<uint8_t> file = ReadBytes(NACRE_SOURCE_DIR "/tests/fuzz/corpus/texture_image/a.jpg");
  CHECK_NOTHROW([&] { ReadImage(NACRE_SOURCE_DIR "/tests/fuzz/corpus/texture_image/a.jpg"); }());
  // A frame header: its marker, a length, the precision, and then rows and columns.
  const uint8_t progressive[] = {0xff, 0xc2}, baseline[] = {0xff, 0xc0};
  auto frame = std::search(file.begin(), file.end(), std::begin(baseline), std::end(baseline));
  if (frame == file.end()) {
    frame = std::search(file.begin(), file.end(), std::begin(progressive), std::end(progressive));
  }
  REQUIRE(frame != file.end());
  for (const uint8_t marker : {uint8_t{0xc0}, uint8_t{0xc2}}) {
    frame[1] = marker;
    for (size_t k = 0; k < 4; ++k) frame[static_cast<ptrdiff_t>(5 + k)] = k % 2 == 0 ? 0x3e : 0x80;
    WriteBytes(folder / "bomb.jpg", file);  // 16000 x 16000
    RefusedInLittleRoom([&] { ReadImage(folder / "bomb.jpg"); });
  }
}

TEST_CASE("pictures with longer sides than are read say how long they may be") {
  const TestFolder folder;
  const auto message = [&](const std::string& name, const std::vector<uint8_t>& bytes) {
    WriteBytes(folder / name, bytes);
    return Catching([&] { ReadImage(folder / name); }).message;
  };
  const std::string end = " pixels\n  hint: make it smaller";
  CHECK(message("a.png", PngHead(66000, 10, 8, 2)).ends_with("is wider than 65536" + end));
  CHECK(message("a.png", PngHead(10, 66000, 8, 2)).ends_with("is higher than 65536" + end));
  std::vector<uint8_t> jpeg = ReadBytes(NACRE_SOURCE_DIR "/tests/fuzz/corpus/texture_image/a.jpg");
  for (size_t i = 0; i + 9 < jpeg.size(); ++i) {
    if (jpeg[i] != 0xff || jpeg[i + 1] < 0xc0 || jpeg[i + 1] > 0xc2) continue;
    jpeg[i + 7] = jpeg[i + 8] = 0xff;  // of the frame's header: its columns
    break;
  }
  CHECK(message("a.jpg", jpeg).ends_with("is wider or higher than 65500" + end));
}

TEST_CASE("a file that is replaced between its header and its samples is refused") {
  const TestFolder folder;
  const std::string path = folder / "a.png";
  WriteBytes(path, Png(20, 10, 10 * (3 * 20 + 1)));
  const ImageFile image = OpenImage(path);
  WriteBytes(path, Png(4000, 300, 300 * (3 * 4000 + 1)));
  const Caught caught = Catching([&] { ReadImage(image); });
  CHECK(caught.code == ExitCode::kBadInput);
  CHECK(caught.Says("changed while it was being read"));
}

TEST_CASE("an EXR attribute that is longer than its file takes no room") {
  const TestFolder folder;
  const auto refused = [&](const std::string& file) {
    WriteText(folder / "long.exr", file);
    CHECK(RefusedInLittleRoom([&] {
            ReadExr(folder / "long.exr");
          }).Says("long.exr: cannot be read as EXR: "));
  };
  // A text of 2 GiB less a byte, alone, and among all that a header needs.
  const std::string size = "\xff\xff\xff\x7f";
  refused(std::string("\x76\x2f\x31\x01\x02\0\0\0words\0string\0", 21) + size + "no more");
  Picture picture = MakePicture(5, 5);
  picture.header.attributes["words"] = std::string("two words");
  WritePicture(folder / "good.exr", picture, {});
  std::ifstream stream(folder / "good.exr", std::ios::binary);
  std::string file(std::istreambuf_iterator<char>(stream), {});
  const std::string words("words\0string\0", 13);
  REQUIRE(file.find(words) != std::string::npos);
  std::string longer = file;
  refused(longer.replace(file.find(words) + words.size(), size.size(), size));
  // A list of channels that ends before its size: what follows is no attribute.
  const std::string channels("channels\0chlist\0", 16);
  REQUIRE(file.find(channels) != std::string::npos);
  const size_t first_name = file.find(channels) + channels.size() + size.size();
  constexpr size_t kDescription = 16;
  file[file.find('\0', first_name) + 1 + kDescription] = '\0';
  WriteText(folder / "long.exr", file);
  CHECK(
      Catching([&] { ReadExr(folder / "long.exr"); }).Says("its list of channels is not as long"));
}

TEST_CASE("PNM files that end before their pixels are refused, and whole ones are read") {
  const TestFolder folder;
  const std::string whole[] = {
      "P1\n3 2\n1 0 1\n0 1 0",       "P2\n2 1\n255\n1 2",
      "P3\n1 1\n65535\n0 0 9",       std::string("P4\n9 2\n\1\200\2\200", 11),
      "P5\n3 1\n255\nabc",           "P6\n1 1\n65535\nabcdef",
      "PF\n1 1\n-1.0\nabcdefghijkl", "Pf\n2 1\n-1.0\nabcdefgh"};
  for (const std::string& file : whole) {
    CAPTURE(file);
    WriteText(folder / "a.pnm", file);
    CHECK(!ReadImage(folder / "a.pnm").channels.empty());
  }
  for (const std::string head :
       {"P1\n999 999\n1", "P2\n9 9\n255\n1 2", "P3\n9 9\n65535\n1 2 3", "P4\n999 999\nab",
        "P5\n9 9\n255\nabc", "P6\n3 3\n65535\nabcdef", "PF\n60000 600-0\n01.0\n",
        "Pf\n9 1\n-1.0\nabcdefgh",
        // What headers and samples must not be.
        "P2\n1 1\n0\n0", "P2\n1 1\n65536\n1", "P3\n1 1\n255\n-1 0 0", "P2\n1 1\n9\n10",
        "P5\n1 1\n9\n\n", "Pf\n1 1\n0\nabcd", "P1\n1 1\n2", "P7\nWIDTH 1", "P6\n0 1\n255\n"}) {
    CAPTURE(head);
    WriteText(folder / "a.pnm", head);
    const Caught caught = Catching([&] { ReadImage(folder / "a.pnm"); });
    CHECK(caught.code == ExitCode::kBadInput);
    CHECK(caught.Says("a.pnm: cannot be read: "));
  }
}

TEST_CASE("the first bytes choose the reader, among few") {
  const TestFolder folder;
  WriteText(folder / "ppm.png", "P6\n1 1\n255\nabc");
  // Half an ulp of 1: a division or a multiplication by its inverse.
  const float red = ReadImage(folder / "ppm.png").Find("R")->samples.at(0);
  CHECK(std::abs(red - 'a' / 255.0f) <= 0x1p-24f);
  const std::string others[] = {"GIF89a",
                                "BM",
                                "DDS ",
                                "8BPS",
                                "RIFF\x10\0\0\0WEBPVP8 ",
                                "SDPX",
                                std::string("\0\0\0\x18"
                                            "ftypheic",
                                            12),
                                "\x59\xa6\x6a\x95"};
  for (const std::string& head : others) {
    CAPTURE(head);
    for (const char* name : {"a.gif", "a.bmp", "a.dds", "a.psd", "a.webp", "a.dpx", "a.heic",
                             "a.mp4", "a.cr2", "a.png"}) {
      WriteText(folder / name, head + std::string(200, '\1'));
      const Caught caught = Catching([&] { ReadImage(folder / name); });
      CHECK(caught.code == ExitCode::kBadInput);
      CHECK(
          caught.Says("cannot be read: not EXR, PNG, JPEG, WebP, TIFF, Radiance HDR, PNM or TGA"));
    }
  }
}

}  // namespace
}  // namespace nacre
