// SPDX-License-Identifier: Apache-2.0
#include "image_io/hdr_reader.h"

#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <string_view>
#include <vector>

namespace nacre {
namespace {

constexpr int kLargestSide = 65536;
// Rows of other widths are never coded run by run.
constexpr int kShortestCoded = 8, kLongestCoded = 0x7fff;

// The file, byte by byte: `ok` is false once it was too short.
struct Bytes {
  std::string_view rest;
  bool ok = true;

  uint8_t Next() {
    if (rest.empty()) {
      ok = false;
      return 0;
    }
    const auto byte = static_cast<uint8_t>(rest.front());
    rest.remove_prefix(1);
    return byte;
  }
  std::string_view Line() {
    const size_t end = rest.find('\n');
    ok = ok && end != std::string_view::npos;
    if (!ok) return {};
    const std::string_view line = rest.substr(0, end);
    rest.remove_prefix(end + 1);
    return line;
  }
};

struct Size {
  int width = 0, height = 0;
};

// "-Y HEIGHT +X WIDTH".
std::optional<Size> ParseSize(std::string_view line) {
  Size size;
  const auto number = [&](std::string_view before, int* value) {
    if (line.substr(0, before.size()) != before) return false;
    line.remove_prefix(before.size());
    const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), *value);
    line.remove_prefix(static_cast<size_t>(end - line.data()));
    return error == std::errc() && *value >= 1 && *value <= kLargestSide;
  };
  if (!number("-Y ", &size.height) || !number(" +X ", &size.width) || !line.empty()) return {};
  return size;
}

// Up to where pixels begin.
std::optional<Size> ParseHeader(Bytes* bytes) {
  const std::string_view magic = bytes->Line();
  if (magic != "#?RADIANCE" && magic != "#?RGBE") return {};
  bool rgbe = false;
  for (std::string_view line = bytes->Line(); bytes->ok && !line.empty(); line = bytes->Line()) {
    if (line.substr(0, 7) == "FORMAT=") rgbe = line == "FORMAT=32-bit_rle_rgbe";
  }
  if (!rgbe || !bytes->ok) return {};
  return ParseSize(bytes->Line());
}

using Row = std::vector<std::array<uint8_t, 4>>;

// One component of a row: runs, of one byte or of many.
bool ReadRuns(size_t component, Bytes* bytes, Row* row) {
  for (size_t x = 0; x < row->size();) {
    const uint8_t code = bytes->Next();
    const bool same = code > 128;
    const size_t count = same ? code - 128u : code;
    if (count == 0 || count > row->size() - x || !bytes->ok) return false;
    const uint8_t value = same ? bytes->Next() : 0;
    for (size_t i = 0; i < count; ++i) (*row)[x++][component] = same ? value : bytes->Next();
  }
  return bytes->ok;
}

bool ReadRow(Bytes* bytes, Row* row) {
  std::array<uint8_t, 4> first{};
  for (uint8_t& byte : first) byte = bytes->Next();
  const auto width = static_cast<int>(row->size());
  const bool may_be_coded = width >= kShortestCoded && width <= kLongestCoded;
  if (may_be_coded && first[0] == 2 && first[1] == 2 && first[2] < 128) {
    if ((first[2] << 8 | first[3]) != width) return false;
    for (size_t component = 0; component < 4; ++component) {
      if (!ReadRuns(component, bytes, row)) return false;
    }
    return true;
  }
  // As it is, but for the oldest files' repetitions.
  for (size_t x = 0; x < row->size(); ++x) {
    if (x > 0) {
      for (uint8_t& byte : first) byte = bytes->Next();
    }
    if (first[0] == 1 && first[1] == 1 && first[2] == 1) return false;
    (*row)[x] = first;
  }
  return bytes->ok;
}

// The whole file if it begins as these do, and is not far longer than pictures are.
std::string ReadText(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  std::array<char, 2> sign{};
  stream.read(sign.data(), sign.size());
  if (!stream || sign[0] != '#' || sign[1] != '?') return {};
  stream.seekg(0, std::ios::end);
  const std::streamoff length = stream.tellg();
  constexpr std::streamoff kLongest = std::streamoff{1} << 32;
  if (length < 2 || length > kLongest) return {};
  std::string text(static_cast<size_t>(length), '\0');
  stream.seekg(0);
  stream.read(text.data(), length);
  if (!stream) return {};
  return text;
}

}  // namespace

std::optional<Image> ReadPlainHdr(const std::string& path, uint64_t max_samples) {
  const std::string text = ReadText(path);
  Bytes bytes{text};
  const std::optional<Size> size = ParseHeader(&bytes);
  if (!size) return {};
  const auto pixels = static_cast<uint64_t>(size->width) * static_cast<uint64_t>(size->height);
  // A run of 127 pixels takes 8 bytes: what is far shorter is broken, and nothing is made for it.
  if (3 * pixels > max_samples || pixels / 16 > text.size()) return {};
  Image image;
  image.display = image.data = {0, 0, size->width, size->height};
  for (const char* name : {"R", "G", "B"}) {
    image.channels.push_back({name, PixelType::kFloat, std::vector<float>(pixels)});
  }
  Row row(static_cast<size_t>(size->width));
  size_t i = 0;
  for (int y = 0; y < size->height; ++y) {
    if (!ReadRow(&bytes, &row)) return {};
    for (const auto& [r, g, b, exponent] : row) {
      const float scale = exponent == 0 ? 0.0f : std::ldexp(1.0f, exponent - (128 + 8));
      image.channels[0].samples[i] = static_cast<float>(r) * scale;
      image.channels[1].samples[i] = static_cast<float>(g) * scale;
      image.channels[2].samples[i] = static_cast<float>(b) * scale;
      ++i;
    }
  }
  image.metadata["transfer"] = "linear";
  return image;
}

}  // namespace nacre
