// SPDX-License-Identifier: Apache-2.0
// image_io/hdr_reader.cc: reads Radiance pictures.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "base/float_mode.h"
#include "base/numbers.h"
#include "base/parallel.h"
#include "base/vec.h"
#include "color/primaries.h"
#include "image_io/format_readers.h"
#include "image_io/orientation.h"

namespace nacre {
namespace {

constexpr int kLargestSide = 65536;
// kShortestCoded and kLongestCoded limit the width of rows that are run-length encoded.
constexpr int kRowsAtATime = 16;
constexpr int kShortestCoded = 8, kLongestCoded = 0x7fff;

// Reads the file byte by byte. Throws at its end.
class HdrBytes {
 public:
  // `buffered`: the largest count that Peek will be called with.
  explicit HdrBytes(const std::string& path, size_t buffered = 0)
      : path_(path),
        file_(path, std::ios::binary),
        buffer_(std::max(size_t{1} << 16, 4 * buffered)) {}

  uint8_t Next() {
    if (next_ == end_) Fill();
    return static_cast<uint8_t>(buffer_[next_++]);
  }
  // The next `count` bytes, which Skip consumes; null if the file ends before.
  const char* Peek(size_t count) {
    if (end_ - next_ < count) {
      std::copy(buffer_.begin() + next_, buffer_.begin() + end_, buffer_.begin());
      end_ -= std::exchange(next_, 0);
      end_ += ReadInto(end_);
    }
    return end_ - next_ >= count ? buffer_.data() + next_ : nullptr;
  }
  void Skip(size_t count) { next_ += count; }
  // The number of bytes consumed.
  uint64_t position() const { return read_ - (end_ - next_); }
  std::string Line() {
    constexpr size_t kLongest = 1 << 16;
    std::string line;
    for (char c = static_cast<char>(Next()); c != '\n'; c = static_cast<char>(Next())) {
      if (line.size() == kLongest) FailToRead(path_, "a line of its header has no end");
      line += c;
    }
    if (line.ends_with('\r')) line.pop_back();
    return line;
  }

 private:
  size_t ReadInto(size_t first) {
    file_.read(buffer_.data() + first, static_cast<std::streamsize>(buffer_.size() - first));
    read_ += static_cast<uint64_t>(file_.gcount());
    return static_cast<size_t>(file_.gcount());
  }
  void Fill() {
    next_ = 0;
    end_ = ReadInto(0);
    if (end_ == 0) FailToRead(path_, "it is cut off");
  }

  std::string path_;
  std::ifstream file_;
  std::vector<char> buffer_;
  size_t next_ = 0, end_ = 0;
  uint64_t read_ = 0;
};

struct HdrHeader {
  int width = 0, height = 0;  // after applying the orientation
  Orientation orientation;
  Vec3d exposure{1, 1, 1};  // the factor that pixels were multiplied by
  double pixel_aspect = 1;  // height of a pixel over its width
  bool is_xyz = false;      // pixels are X, Y and Z, whatever PRIMARIES says
  std::map<std::string, std::string> variables;
};

// Parses "-Y HEIGHT +X WIDTH" and its seven variants: the axis along which rows follow each other,
// then that within a row. Y grows upwards, so -Y means that rows go from the top down.
bool ParseResolution(std::string_view line, HdrHeader* header) {
  const auto axis = [&](char* sign, char* name, int* size) {
    while (line.starts_with(' ')) line.remove_prefix(1);
    if (line.size() < 3 || (line[0] != '-' && line[0] != '+')) return false;
    *sign = line[0];
    *name = line[1];
    line.remove_prefix(2);
    while (line.starts_with(' ')) line.remove_prefix(1);
    const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), *size);
    line.remove_prefix(static_cast<size_t>(end - line.data()));
    return error == std::errc() && *size >= 1 && *size <= kLargestSide;
  };
  char signs[2] = {}, names[2] = {};
  int sizes[2] = {};
  for (int i = 0; i < 2; ++i) {
    if (!axis(&signs[i], &names[i], &sizes[i])) return false;
  }
  while (line.ends_with(' ')) line.remove_suffix(1);
  const bool row_by_row = names[0] == 'Y' && names[1] == 'X';
  if (!line.empty() || (!row_by_row && (names[0] != 'X' || names[1] != 'Y'))) return false;
  const int x = row_by_row ? 1 : 0, y = 1 - x;
  header->width = sizes[x];
  header->height = sizes[y];
  header->orientation = {!row_by_row, signs[x] == '-', signs[y] == '+'};
  return true;
}

// Radiance's own primaries, with the equal-energy white. Files without PRIMARIES have these in
// Radiance, but Rec. 709's everywhere else. Both are read as Rec. 709: red and blue are the same,
// and the greens differ by 0.01.
const Primaries kRadiancePrimaries = {{.640, .330}, {.290, .600}, {.150, .060}, {1 / 3., 1 / 3.}};

// Converts XYZ to radiance as ra_xyze -r does. Y is in lumens per steradian and square metre: it is
// divided by the 179 lumens per watt of white light (WHTEFFICACY). The result is in Radiance's own
// primaries.
Imath::M33d RadianceFromXyz() {
  constexpr double kWhiteEfficacy = 179;
  return XyzFromRgb(kRadiancePrimaries).inverse() * (1 / kWhiteEfficacy);
}

// Reads a line "NAME=value". Other lines are comments, or the commands that made the picture.
void ReadVariable(const std::string& path, const std::string& line, HdrHeader* header) {
  const size_t equals = line.find('=');
  if (equals == std::string::npos || line.starts_with('#') || line.starts_with('\t')) return;
  const std::string name = line.substr(0, equals);
  std::string value = line.substr(equals + 1);
  const auto is_space = [](char c) { return c == ' ' || c == '\t'; };
  while (!value.empty() && is_space(value.back())) value.pop_back();
  while (!value.empty() && is_space(value.front())) value.erase(0, 1);
  const auto numbers = [&](size_t count) {
    const auto parsed = ParseNumbers(value);
    if (!parsed || parsed->size() != count) {
      FailToRead(path, fmt::format("{} is not {} number{}", name, count, count == 1 ? "" : "s"));
    }
    return *parsed;
  };
  // For factors: FreeImage writes EXPOSURE=0 if it does not know the exposure.
  const auto says_nothing = [&](size_t count) {
    const std::vector<double> all = numbers(count);
    return std::ranges::all_of(all, [](double number) { return number == 0; });
  };
  const auto multiply = [&](double number, double* factor) {
    *factor *= number;
    if (!(*factor > 0) || !std::isfinite(*factor)) {
      FailToRead(path, name + " makes no factor above 0");
    }
  };
  const auto expose = [&](size_t count) {
    const std::vector<double> all = numbers(count);
    for (int c = 0; c < 3; ++c) {
      multiply(all[count == 1 ? 0 : static_cast<size_t>(c)], &header->exposure[c]);
    }
  };
  if (name == "FORMAT") {
    header->is_xyz = value == "32-bit_rle_xyze";
    if (!header->is_xyz && value != "32-bit_rle_rgbe") {
      FailToRead(path, "its FORMAT is neither 32-bit_rle_rgbe nor 32-bit_rle_xyze");
    }
  }
  if (name == "EXPOSURE" && !says_nothing(1)) expose(1);
  if (name == "COLORCORR" && !says_nothing(3)) expose(3);
  if (name == "PRIMARIES") {
    const std::optional<Primaries> primaries = ParsePrimaries(value);
    if (!primaries || !SamePrimaries(*primaries, kRadiancePrimaries)) {
      header->variables["chromaticities"] = value;  // EXR's name for the same numbers
      return;
    }
  }
  if (name == "GAMMA" && !says_nothing(1) && numbers(1)[0] != 1) {
    throw Error(ExitCode::kBadInput, path, "its GAMMA is not 1", "pixels must be linear");
  }
  if (name == "PIXASPECT" && !says_nothing(1)) {
    multiply(numbers(1)[0], &header->pixel_aspect);
    // EXR has pixel width over height, Radiance the reciprocal.
    header->variables["pixelAspectRatio"] = fmt::format("{:.6g}", 1 / header->pixel_aspect);
    return;
  }
  std::string& known = header->variables[name];
  known += known.empty() ? value : ", " + value;
}

HdrHeader ReadHeader(const std::string& path, HdrBytes* bytes) {
  HdrHeader header;
  for (std::string line = bytes->Line(); !line.empty(); line = bytes->Line()) {
    ReadVariable(path, line, &header);
  }
  if (header.is_xyz) header.variables.erase("chromaticities");
  std::string resolution;
  while (resolution.empty()) resolution = bytes->Line();  // some files have several empty lines
  if (!ParseResolution(resolution, &header)) {
    FailToRead(path, "its resolution is not like -Y 512 +X 1024, up to 65536 a side");
  }
  return header;
}

using Row = std::vector<std::array<uint8_t, 4>>;

class RowReader {
 public:
  // `pixels`: how many the file should hold.
  RowReader(const std::string& path, HdrBytes* bytes, uint64_t pixels)
      : path_(path), bytes_(bytes) {
    // A file whose size is exactly that of all pixels has no repetitions: in it, (1, 1, 1, n) is a
    // colour. Run-length encoded rows, which may happen to have that size, begin with their marker.
    const bool as_many = FileBytes(path) == bytes->position() + 4 * pixels;
    const char* const first = bytes->Peek(2);
    repeats_nothing_ = as_many && first != nullptr && !(first[0] == 2 && first[1] == 2);
  }

  void Read(Row* row) {
    if (TakePlain(row)) return;
    std::array<uint8_t, 4> first = NextPixel();
    const auto width = static_cast<int>(row->size());
    const bool may_be_coded = width >= kShortestCoded && width <= kLongestCoded;
    if (may_be_coded && first[0] == 2 && first[1] == 2 && first[2] < 128) {
      if ((first[2] << 8 | first[3]) != width) {
        FailToRead(path_, "a row is not as long as its header says");
      }
      for (size_t component = 0; component < 4; ++component) ReadRuns(component, row);
      return;
    }
    ReadPlain(first, row);
  }

 private:
  // Takes a row that is neither run-length encoded nor has repetitions; returns whether it did.
  bool TakePlain(Row* row) {
    const size_t size = 4 * row->size();
    const char* const bytes = bytes_->Peek(size);
    if (bytes == nullptr) return false;
    if (!repeats_nothing_) {
      bool repeats = false;
      for (size_t i = 0; i < size; i += 4) {
        repeats |= bytes[i] == 1 && bytes[i + 1] == 1 && bytes[i + 2] == 1;
      }
      if (repeats || (bytes[0] == 2 && bytes[1] == 2)) return false;
    }
    std::memcpy(row->data(), bytes, size);
    bytes_->Skip(size);
    return true;
  }

  std::array<uint8_t, 4> NextPixel() {
    std::array<uint8_t, 4> pixel{};
    for (uint8_t& byte : pixel) byte = bytes_->Next();
    return pixel;
  }

  // Reads one component of a row: runs of one repeated byte, or of literal bytes.
  void ReadRuns(size_t component, Row* row) {
    for (size_t x = 0; x < row->size();) {
      const uint8_t code = bytes_->Next();
      const bool same = code > 128;
      const size_t count = same ? code - 128u : code;
      if (count == 0 || count > row->size() - x) {
        FailToRead(path_, "a run is longer than its row");
      }
      const uint8_t value = same ? bytes_->Next() : 0;
      for (size_t i = 0; i < count; ++i) (*row)[x++][component] = same ? value : bytes_->Next();
    }
  }

  // Reads pixels. (1, 1, 1, n) repeats the previous pixel n times; if another such marker follows
  // immediately, it holds the next higher 8 bits of the count.
  void ReadPlain(std::array<uint8_t, 4> pixel, Row* row) {
    int shift = 0;
    for (size_t x = 0; x < row->size();) {
      if (pixel[0] == 1 && pixel[1] == 1 && pixel[2] == 1) {
        const size_t count = shift < 24 ? size_t{pixel[3]} << shift : row->size() + 1;
        if (x == 0 || count > row->size() - x) {
          FailToRead(path_, "a repetition is longer than its row");
        }
        for (size_t i = 0; i < count; ++i, ++x) (*row)[x] = (*row)[x - 1];
        shift += 8;
      } else {
        (*row)[x++] = pixel;
        shift = 0;
      }
      if (x < row->size()) pixel = NextPixel();
    }
  }

  const std::string& path_;
  HdrBytes* bytes_;
  bool repeats_nothing_ = false;
};

// `size`: the size of the image when it was opened.
void ReadPixels(const std::string& path, const Window& size, const Window& region,
                std::span<const SampleTarget> targets) {
  HdrBytes bytes(path, size_t{4} * static_cast<size_t>(std::max(size.width(), size.height())));
  const HdrHeader header = ReadHeader(path, &bytes);
  const RowPlacer placer(header.orientation, {0, 0, header.width, header.height}, region, targets);
  CheckUnchanged(path, header.width == size.width() && header.height == size.height());
  const auto width = static_cast<size_t>(placer.stored_width());
  RowReader reader(path, &bytes, static_cast<uint64_t>(header.width) * header.height);
  std::array<double, 256> scales{};  // indexed by exponent
  for (int exponent = 1; exponent < 256; ++exponent) {
    scales[static_cast<size_t>(exponent)] = std::ldexp(1.0, exponent - (128 + 8));
  }
  const bool exposed = header.exposure != Vec3d(1, 1, 1);
  const Imath::M33d rgb_from_xyz = RadianceFromXyz();
  // Rows are read one by one, and converted several at a time.
  std::vector<Row> rows(kRowsAtATime, Row(width));
  std::vector<std::vector<float>> values(kRowsAtATime, std::vector<float>(3 * width));
  for (int first = 0; first < placer.stored_height(); first += kRowsAtATime) {
    const int count = std::min(kRowsAtATime, placer.stored_height() - first);
    for (int i = 0; i < count; ++i) reader.Read(&rows[static_cast<size_t>(i)]);
    ParallelFor(static_cast<size_t>(count), 0, [&](size_t i) {
      const DefaultFloatMode mode;  // samples may be denormal
      const Row& row = rows[i];
      float* const to = values[i].data();
      for (size_t x = 0; x < width; ++x) {
        const double scale = scales[row[x][3]];
        Vec3d value(row[x][0] * scale, row[x][1] * scale, row[x][2] * scale);
        if (exposed) value /= header.exposure;
        if (header.is_xyz) value *= rgb_from_xyz;
        // Colours outside of the gamut are clipped, as ra_xyze -r does, since RGBE has no signs.
        for (int c = 0; c < 3; ++c)
          to[3 * x + static_cast<size_t>(c)] = static_cast<float>(std::max(value[c], 0.0));
      }
      placer.Place(first + static_cast<int>(i), to, 3);
    });
  }
}

}  // namespace

ImageFile OpenHdr(const std::string& path) {
  HdrBytes bytes(path);
  HdrHeader header = ReadHeader(path, &bytes);
  // Checks a lower bound on the file's size before memory for its pixels is allocated. The densest
  // rows, those of the oldest files, repeat a pixel 65536 times in 16 bytes, or 4096 times per
  // byte.
  const double pixels = static_cast<double>(header.width) * header.height;
  if (pixels / 4096 > static_cast<double>(FileBytes(path))) FailToRead(path, "it is cut off");
  header.variables["transfer"] = "linear";
  ImageFile image = MakeImageFile(path, header.width, header.height, /*is_color=*/true,
                                  /*has_alpha=*/false, std::move(header.variables));
  image.read = [path, size = image.header.data](const Window& region,
                                                std::span<const SampleTarget> targets) {
    ReadPixels(path, size, region, targets);
  };
  return image;
}

}  // namespace nacre
