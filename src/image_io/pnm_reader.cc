// SPDX-License-Identifier: Apache-2.0
// image_io/pnm_reader.cc: reads the portable pixel maps of Netpbm, and PFM.
#include <bit>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstring>
#include <vector>

#include <fmt/format.h>

#include "image_io/c_file.h"
#include "image_io/format_readers.h"
#include "image_io/orientation.h"

namespace nacre {
namespace {

constexpr unsigned kLargestPnmSide = 65536;

struct PnmHeader {
  char kind = 0;  // 1 to 6, f or F
  unsigned width = 0, height = 0;
  unsigned maximum = 1;        // the code of white
  bool little_endian = false;  // for floats
  float scale = 1;             // for floats, which are multiplied by it

  bool is_color() const { return kind == '3' || kind == '6' || kind == 'F'; }
  bool is_text() const { return kind >= '1' && kind <= '3'; }
  bool is_float() const { return kind == 'f' || kind == 'F'; }
  bool operator==(const PnmHeader&) const = default;
};

// An open file, positioned at its first sample.
class PnmFile {
 public:
  explicit PnmFile(const std::string& path) : path_(path), file_(OpenToRead(path)) {
    if (!file_) Fail("it cannot be opened");
    if (std::getc(file_.get()) != 'P') Fail("it is no PNM file");
    header_.kind = static_cast<char>(std::getc(file_.get()));
    header_.width = Number("width", 1, kLargestPnmSide);
    header_.height = Number("height", 1, kLargestPnmSide);
    if (header_.is_float()) {
      const std::string scale = Word();
      double value = 0;
      const auto [end, error] = std::from_chars(scale.data(), scale.data() + scale.size(), value);
      if (error != std::errc() || end != scale.data() + scale.size() || value == 0) {
        Fail("its scale is not a number other than 0");
      }
      header_.little_endian = value < 0;
      header_.scale = static_cast<float>(std::abs(value));
    } else if (header_.kind != '1' && header_.kind != '4') {
      header_.maximum = Number("maximum", 1, 65535);
    }
  }

  const PnmHeader& header() const { return header_; }
  size_t row_samples() const { return size_t{header_.width} * (header_.is_color() ? 3 : 1); }

  // Reads the next row as stored.
  void ReadRow(std::vector<float>* values) {
    if (header_.is_text()) {
      for (float& value : *values) value = TextSample();
    } else if (header_.kind == '4') {
      ReadBytes((header_.width + 7) / 8);
      for (size_t x = 0; x < values->size(); ++x) {
        (*values)[x] = (bytes_[x / 8] >> (7 - x % 8) & 1) != 0 ? 0.0f : 1.0f;
      }
    } else if (header_.is_float()) {
      ReadBytes(4 * values->size());
      for (size_t i = 0; i < values->size(); ++i) {
        uint32_t bits = 0;
        for (size_t k = 0; k < 4; ++k) {
          bits |= uint32_t{bytes_[4 * i + k]} << 8 * (header_.little_endian ? k : 3 - k);
        }
        (*values)[i] = std::bit_cast<float>(bits) * header_.scale;
      }
    } else {
      const size_t width = header_.maximum < 256 ? 1 : 2;
      ReadBytes(width * values->size());
      for (size_t i = 0; i < values->size(); ++i) {
        const unsigned code =
            width == 1 ? bytes_[i] : unsigned{bytes_[2 * i]} << 8 | bytes_[2 * i + 1];
        (*values)[i] = Value(code);
      }
    }
  }

 private:
  [[noreturn]] void Fail(const std::string& reason) const { FailToRead(path_, reason); }

  // Skips blanks and comments, and reads up to and including the blank after a word. Long words are
  // cut.
  std::string Word() {
    int c = std::getc(file_.get());
    while (c == '#' || std::isspace(c) != 0) {
      if (c == '#') {
        while (c != '\n' && c != EOF) c = std::getc(file_.get());
      } else {
        c = std::getc(file_.get());
      }
    }
    std::string word;
    constexpr size_t kLongest = 64;
    for (; c != EOF && std::isspace(c) == 0 && word.size() < kLongest; c = std::getc(file_.get())) {
      word += static_cast<char>(c);
    }
    return word;
  }

  unsigned Number(const char* name, unsigned least, unsigned most) {
    const std::string word = Word();
    unsigned value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (word.empty()) Fail("the file ends too early");
    if (error != std::errc() || end != word.data() + word.size() || value < least || value > most) {
      Fail(fmt::format("its {} is no whole number from {} to {}", name, least, most));
    }
    return value;
  }

  float TextSample() {
    if (header_.kind != '1') return Value(Number("sample", 0, header_.maximum));
    // Bits in text need no blanks between them.
    int c = std::getc(file_.get());
    while (std::isspace(c) != 0) c = std::getc(file_.get());
    if (c != '0' && c != '1') Fail(c == EOF ? "the file ends too early" : "a bit is not 0 or 1");
    return c == '1' ? 0.0f : 1.0f;
  }

  float Value(unsigned code) const {
    if (code > header_.maximum) Fail("a sample is larger than the maximum");
    return static_cast<float>(code) / static_cast<float>(header_.maximum);
  }

  void ReadBytes(size_t count) {
    bytes_.resize(count);
    if (std::fread(bytes_.data(), 1, count, file_.get()) != count) Fail("the file ends too early");
  }

  std::string path_;
  CFile file_;
  PnmHeader header_;
  std::vector<uint8_t> bytes_;
};

// Checks the file against the minimum number of bytes for its samples, before memory is allocated.
void CheckLength(const PnmHeader& header, const std::string& path, uint64_t file_bytes) {
  const uint64_t row = uint64_t{header.width} * (header.is_color() ? 3 : 1);
  uint64_t bytes = row * header.height;
  if (header.kind == '4') bytes = (row + 7) / 8 * header.height;
  if (header.is_float()) bytes *= 4;
  if (bytes <= file_bytes) return;
  FailToRead(path, fmt::format("cut off: {} bytes are too few for {} x {} pixels", file_bytes,
                               header.width, header.height));
}

}  // namespace

ImageFile OpenPnm(const std::string& path) {
  const PnmHeader header = PnmFile(path).header();
  CheckLength(header, path, FileBytes(path));
  ImageFile image = MakeImageFile(
      path, static_cast<int>(header.width), static_cast<int>(header.height), header.is_color(),
      /*has_alpha=*/false, {{"transfer", header.is_float() ? "linear" : "display"}});
  // Opens the file again for each reading, which reads the rows from the first one on.
  image.read = [path, header, data = image.header.data](const Window& region,
                                                        std::span<const SampleTarget> targets) {
    PnmFile file(path);
    CheckUnchanged(path, file.header() == header);
    const Orientation orientation{.flip_y = header.is_float()};
    const RowPlacer placer(orientation, data, region, targets);
    std::vector<float> values(file.row_samples());
    for (int y = 0; y < placer.stored_height(); ++y) {
      file.ReadRow(&values);
      placer.Place(y, values.data(), header.is_color() ? 3 : 1);
    }
  };
  return image;
}

}  // namespace nacre
