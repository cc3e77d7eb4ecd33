// SPDX-License-Identifier: Apache-2.0
// image_io/tiff_check.cc: WhatTiffLacks() of format_readers.h. It is not a reader: files that
// libtiff itself refuses are left to it.
#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include <fmt/format.h>
#include <sys/types.h>

#include "image_io/c_file.h"
#include "image_io/format_readers.h"

namespace nacre {
namespace {

// Tags of TIFF 6.0, part 1; those for tiles are in part 2.
enum Tag : uint16_t {
  kImageWidth = 256,
  kImageLength = 257,
  kBitsPerSample = 258,
  kCompression = 259,
  kPhotometric = 262,
  kStripOffsets = 273,
  kSamplesPerPixel = 277,
  kRowsPerStrip = 278,
  kStripByteCounts = 279,
  kPlanarConfiguration = 284,
  kColorMap = 320,
  kTileWidth = 322,
  kTileLength = 323,
  kTileOffsets = 324,
  kTileByteCounts = 325,
};

constexpr uint64_t kRgb = 2, kPalette = 3, kYCbCr = 6, kCieLab = 8;  // kPhotometric

// Grey (0: white is zero), RGB, palette, mask, inks, YCbCr and the three Lab of TIFF 6.0 and its
// supplements; LogL and LogLuv.
constexpr std::array<uint64_t, 12> kPhotometrics = {0, 1, 2, 3, 4, 5, 6, 8, 9, 10, 32844, 32845};

constexpr size_t kMostFields = 4096;  // in a directory; cameras write about a hundred

struct Field {
  uint16_t type = 0;
  uint64_t count = 0;
  std::array<uint8_t, 8> value{};  // or its offset in the file
};

// The first directory of a file.
class Directory {
 public:
  // Returns nullopt if there is none.
  static std::optional<Directory> Read(const std::string& path) {
    Directory directory;
    directory.file_ = OpenToRead(path);
    std::error_code error;
    directory.file_bytes_ = std::filesystem::file_size(path, error);
    if (!directory.file_ || error || !directory.ReadFields()) return std::nullopt;
    return directory;
  }

  bool has(Tag tag) const { return fields_.contains(tag); }
  uint64_t count(Tag tag) const { return has(tag) ? fields_.at(tag).count : 0; }
  uint64_t file_bytes() const { return file_bytes_; }

  // The values of a field of whole numbers; fewer than its count if the file ends before, or if the
  // type is another one.
  std::vector<uint64_t> Numbers(Tag tag) {
    if (!has(tag)) return {};
    const Field& field = fields_.at(tag);
    const size_t size = field.type == 1                        ? 1
                        : field.type == 3                      ? 2
                        : field.type == 4                      ? 4
                        : field.type == 16 || field.type == 18 ? 8
                                                               : 0;
    if (size == 0 || field.count > file_bytes_ / size) return {};
    std::vector<uint8_t> bytes(size * field.count);
    const size_t inside = is_big_ ? 8 : 4;
    if (bytes.size() <= inside) {
      std::copy_n(field.value.begin(), bytes.size(), bytes.begin());
    } else if (!ReadAt(Number({field.value.data(), inside}), bytes)) {
      return {};
    }
    std::vector<uint64_t> numbers(field.count);
    for (size_t i = 0; i < numbers.size(); ++i) numbers[i] = Number({&bytes[i * size], size});
    return numbers;
  }

  uint64_t Number(Tag tag, uint64_t otherwise) {
    const std::vector<uint64_t> numbers = Numbers(tag);
    return numbers.empty() ? otherwise : numbers[0];
  }

 private:
  uint64_t Number(std::span<const uint8_t> bytes) const {
    uint64_t number = 0;
    for (size_t i = 0; i < bytes.size(); ++i) {
      number = number << 8 | bytes[is_little_ ? bytes.size() - 1 - i : i];
    }
    return number;
  }

  bool ReadAt(uint64_t place, std::span<uint8_t> to) {
    if (place > file_bytes_ || to.size() > file_bytes_ - place) return false;
    return fseeko(file_.get(), static_cast<off_t>(place), SEEK_SET) == 0 &&
           std::fread(to.data(), 1, to.size(), file_.get()) == to.size();
  }

  // TIFF 6.0, p. 13 to 15; BigTIFF has 8-byte numbers.
  bool ReadFields() {
    std::array<uint8_t, 16> head{};
    const std::span<uint8_t> bytes(head);
    if (!ReadAt(0, bytes.first(8))) return false;
    is_little_ = head[0] == 'I';
    const uint64_t version = Number(bytes.subspan(2, 2));
    if (version != 42 && version != 43) return false;
    is_big_ = version == 43;
    if (is_big_ && !ReadAt(8, bytes.subspan(8, 8))) return false;
    const uint64_t place = Number(is_big_ ? bytes.subspan(8, 8) : bytes.subspan(4, 4));
    const size_t count_size = is_big_ ? 8 : 2, number_size = is_big_ ? 8 : 4;
    const size_t field_size = 4 + 2 * number_size;
    if (!ReadAt(place, bytes.first(count_size))) return false;
    const uint64_t count = Number(bytes.first(count_size));
    if (count > kMostFields) return false;
    std::vector<uint8_t> table(count * field_size);
    if (!ReadAt(place + count_size, table)) return false;
    for (size_t i = 0; i < count; ++i) {
      const std::span<const uint8_t> entry(&table[i * field_size], field_size);
      Field field;
      field.type = static_cast<uint16_t>(Number(entry.subspan(2, 2)));
      field.count = Number(entry.subspan(4, number_size));
      std::ranges::copy(entry.subspan(4 + number_size), field.value.begin());
      fields_.emplace(static_cast<uint16_t>(Number(entry.first(2))), field);  // the first counts
    }
    return true;
  }

  CFile file_;
  uint64_t file_bytes_ = 0;
  bool is_little_ = true, is_big_ = false;
  std::map<uint16_t, Field> fields_;
};

// Why the samples cannot be interpreted, or are too few for their interpretation; "" if all is
// well.
std::string WhatColorsLack(Directory* d) {
  if (!d->has(kPhotometric)) return "it does not say what its samples mean";
  const uint64_t photometric = d->Number(kPhotometric, 0);
  if (std::ranges::find(kPhotometrics, photometric) == kPhotometrics.end()) {
    return fmt::format("its photometric interpretation, {}, is unknown", photometric);
  }
  const uint64_t samples = d->Number(kSamplesPerPixel, 1);
  const bool three = photometric == kRgb || photometric == kYCbCr || photometric == kCieLab;
  if (three && samples < 3) {
    return fmt::format("its pixels have {} samples where colours have 3", samples);
  }
  if (photometric != kPalette) return {};
  const uint64_t bits = d->Number(kBitsPerSample, 1);
  if (samples != 1 || bits > 16) {
    return fmt::format(
        "its pixels have {} samples of {} bits where a palette is chosen from by one "
        "of at most 16",
        samples, bits);
  }
  const uint64_t colors = uint64_t{1} << bits;
  if (d->count(kColorMap) == 3 * colors) return {};
  return d->has(kColorMap) ? fmt::format("its palette has {} numbers where {} colours have {}",
                                         d->count(kColorMap), colors, 3 * colors)
                           : "its palette is missing";
}

std::string WhatBlocksLack(Directory* d) {
  constexpr uint64_t kMostSide = 1 << 30;
  const uint64_t width = d->Number(kImageWidth, 0), height = d->Number(kImageLength, 0);
  const uint64_t samples = d->Number(kSamplesPerPixel, 1), bits = d->Number(kBitsPerSample, 1);
  const bool is_tiled = d->has(kTileOffsets);
  const uint64_t block_width = is_tiled ? d->Number(kTileWidth, 0) : width;
  const uint64_t block_height =
      is_tiled ? d->Number(kTileLength, 0) : std::min(d->Number(kRowsPerStrip, height), height);
  for (const uint64_t side : {width, height, block_width, block_height}) {
    if (side < 1 || side > kMostSide) return {};  // libtiff reports it
  }
  if (samples < 1 || samples > 0xffff || bits < 1 || bits > 64) return {};
  const bool separate = d->Number(kPlanarConfiguration, 1) == 2;
  const char* const name = is_tiled ? "tile" : "strip";
  const uint64_t across = (width + block_width - 1) / block_width;
  const uint64_t down = (height + block_height - 1) / block_height;
  const uint64_t in_plane = across * down, count = in_plane * (separate ? samples : 1);
  const uint64_t row_bytes = (block_width * (separate ? 1 : samples) * bits + 7) / 8;
  // The rows of a block, as the last strips are shortened, and tiles are not.
  const auto rows_of = [&](uint64_t block) {
    const uint64_t first = block % in_plane / across * block_height;
    return is_tiled ? block_height : std::min(block_height, height - first);
  };
  const Tag place_tag = is_tiled ? kTileOffsets : kStripOffsets;
  const Tag bytes_tag = is_tiled ? kTileByteCounts : kStripByteCounts;
  if (d->count(place_tag) < count || d->count(bytes_tag) < count) {
    return fmt::format("it has {} {}s of {}", std::min(d->count(place_tag), d->count(bytes_tag)),
                       name, count);
  }
  const std::vector<uint64_t> places = d->Numbers(place_tag), bytes = d->Numbers(bytes_tag);
  if (places.size() < count || bytes.size() < count) return "the table of its strips is cut off";
  // Uncompressed YCbCr has subsampled chroma: checking its length is left to libtiff.
  const bool is_plain = d->Number(kCompression, 1) == 1 && d->Number(kPhotometric, 0) != kYCbCr;
  for (uint64_t i = 0; i < count; ++i) {
    if (places[i] == 0 || bytes[i] == 0) {
      return fmt::format("{} {} of {} is missing", name, i, count);
    }
    const uint64_t needed = is_plain ? row_bytes * rows_of(i) : 1;
    if (bytes[i] < needed) {
      return fmt::format("{} {} of {} has {} of {} bytes", name, i, count, bytes[i], needed);
    }
    if (places[i] > d->file_bytes() || bytes[i] > d->file_bytes() - places[i]) {
      return fmt::format("{} {} of {} goes on behind the end of the file", name, i, count);
    }
  }
  return {};
}

}  // namespace

std::string WhatTiffLacks(const std::string& path) {
  std::optional<Directory> directory = Directory::Read(path);
  if (!directory) return {};
  std::string lacks = WhatColorsLack(&*directory);
  return lacks.empty() ? WhatBlocksLack(&*directory) : lacks;
}

}  // namespace nacre
