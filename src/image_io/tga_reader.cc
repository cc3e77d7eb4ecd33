// SPDX-License-Identifier: Apache-2.0
// image_io/tga_reader.cc: reads Truevision TGA files.
#include <array>
#include <vector>

#include "image_io/c_file.h"
#include "image_io/format_readers.h"
#include "image_io/orientation.h"

namespace nacre {
namespace {

struct TgaHeader {
  enum class Kind : uint8_t { kPalette = 1, kColor = 2, kGrey = 3 };
  Kind kind = Kind::kColor;
  bool has_runs = false;
  int width = 0, height = 0;
  size_t pixel_bits = 0;
  size_t first_color = 0, color_count = 0, color_bits = 0;  // of the palette
  bool has_alpha = false;
  Orientation orientation;

  size_t channels() const { return kind == Kind::kGrey ? 1 : has_alpha ? 4 : 3; }
  bool operator==(const TgaHeader&) const = default;
};

using Color = std::array<float, 4>;  // R G B A, or Y first

// An open file, positioned at its first pixel.
class TgaFile {
 public:
  explicit TgaFile(const std::string& path) : path_(path), file_(OpenToRead(path)) {
    if (!file_) Fail("it cannot be opened");
    std::array<uint8_t, 18> bytes{};
    for (uint8_t& byte : bytes) byte = Byte();
    const auto number = [&](size_t at) { return bytes[at] | bytes[at + 1] << 8; };
    header_.has_runs = (bytes[2] & 8) != 0;
    const int kind = bytes[2] & ~8;
    if (kind < 1 || kind > 3) Fail("it is no TGA image of a known kind");
    header_.kind = static_cast<TgaHeader::Kind>(kind);
    header_.width = number(12);
    header_.height = number(14);
    header_.pixel_bits = bytes[16];
    if (header_.width < 1 || header_.height < 1) Fail("it has no pixels");
    if (bytes[1] == 1) {
      header_.first_color = static_cast<size_t>(number(3));
      header_.color_count = static_cast<size_t>(number(5));
      header_.color_bits = bytes[7];
    }
    const bool is_palette = header_.kind == TgaHeader::Kind::kPalette;
    const bool is_grey = header_.kind == TgaHeader::Kind::kGrey;
    if (is_palette && bytes[1] != 1) Fail("it has no palette");
    const auto is_color = [](size_t bits) {
      return bits == 15 || bits == 16 || bits == 24 || bits == 32;
    };
    const size_t bits = header_.pixel_bits;
    const bool known = is_palette ? (bits == 8 || bits == 16) && is_color(header_.color_bits)
                       : is_grey  ? bits == 8
                                  : is_color(bits);
    if (!known) Fail("its pixels have a size that TGA files do not have");
    // The number of alpha bits. Programs leave it 0 for palettes, which then have no alpha.
    header_.has_alpha = !is_grey && (bytes[17] & 0x0f) != 0;
    // Rows are stored from the bottom up unless this bit says otherwise.
    header_.orientation = {false, (bytes[17] & 0x10) != 0, (bytes[17] & 0x20) == 0};
    for (int i = 0; i < bytes[0]; ++i) Byte();  // an image id, ignored
    for (size_t i = 0; i < header_.color_count; ++i) {
      palette_.push_back(ReadColor(header_.color_bits));
    }
  }

  const TgaHeader& header() const { return header_; }

  // Reads the next row as stored. Runs may continue from one row into the next.
  void ReadRow(std::vector<float>* values) {
    const size_t channels = header_.channels();
    for (size_t i = 0; i < values->size(); i += channels) {
      const Color color = NextPixel();
      for (size_t c = 0; c < channels; ++c) (*values)[i + c] = color[c];
    }
  }

  // To be called after the last row: checks that no run continues.
  void Finish() const {
    if (left_ > 0) Fail("a run is longer than the image");
  }

 private:
  [[noreturn]] void Fail(const std::string& reason) const { FailToRead(path_, reason); }

  uint8_t Byte() {
    const int byte = std::getc(file_.get());
    if (byte == EOF) Fail("the file ends too early");
    return static_cast<uint8_t>(byte);
  }

  Color ReadColor(size_t bits) {
    const auto of_five = [](int value) { return static_cast<float>(value & 31) / 31; };
    const auto of_eight = [](uint8_t value) { return static_cast<float>(value) / 255; };
    if (bits <= 16) {
      const int low = Byte(), word = low | Byte() << 8;
      return {of_five(word >> 10), of_five(word >> 5), of_five(word),
              word >> 15 != 0 ? 1.0f : 0.0f};
    }
    const uint8_t blue = Byte(), green = Byte(), red = Byte();
    return {of_eight(red), of_eight(green), of_eight(blue), bits == 32 ? of_eight(Byte()) : 1.0f};
  }

  Color ReadPixel() {
    if (header_.kind == TgaHeader::Kind::kGrey) return {static_cast<float>(Byte()) / 255};
    if (header_.kind == TgaHeader::Kind::kColor) return ReadColor(header_.pixel_bits);
    size_t index = Byte();
    if (header_.pixel_bits == 16) index |= size_t{Byte()} << 8;
    if (index < header_.first_color || index - header_.first_color >= palette_.size()) {
      Fail("a pixel is beyond its palette");
    }
    return palette_[index - header_.first_color];
  }

  Color NextPixel() {
    if (!header_.has_runs) return ReadPixel();
    if (left_ == 0) {
      const uint8_t code = Byte();
      left_ = (code & 0x7f) + 1;
      is_run_ = (code & 0x80) != 0;
      if (is_run_) run_ = ReadPixel();
    }
    --left_;
    return is_run_ ? run_ : ReadPixel();
  }

  std::string path_;
  CFile file_;
  TgaHeader header_;
  std::vector<Color> palette_;
  int left_ = 0;  // pixels left in the current packet
  bool is_run_ = false;
  Color run_{};
};

}  // namespace

ImageFile OpenTga(const std::string& path) {
  const TgaHeader header = TgaFile(path).header();
  ImageFile image =
      MakeImageFile(path, header.width, header.height, header.kind != TgaHeader::Kind::kGrey,
                    header.has_alpha, {{"transfer", "display"}});
  // Opens the file again for each reading, which reads the rows from the first one on.
  image.read = [path, header, data = image.header.data](const Window& region,
                                                        std::span<const SampleTarget> targets) {
    TgaFile file(path);
    CheckUnchanged(path, file.header() == header);
    const RowPlacer placer(header.orientation, data, region, targets);
    std::vector<float> values(static_cast<size_t>(header.width) * header.channels());
    for (int y = 0; y < header.height; ++y) {
      file.ReadRow(&values);
      placer.Place(y, values.data(), header.channels());
    }
    file.Finish();
  };
  return image;
}

}  // namespace nacre
