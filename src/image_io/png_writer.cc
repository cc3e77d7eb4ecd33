// SPDX-License-Identifier: Apache-2.0
#include "image_io/png_writer.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include <isa-l/crc.h>
#include <isa-l/igzip_lib.h>
#include <zlib.h>

#include "base/error.h"
#include "base/parallel.h"
#include "base/pool.h"
#include "base/version.h"
#include "image_io/deflate.h"
#include "image_io/in_order.h"
#include "image_io/output_file.h"

namespace nacre {
namespace {

using Bytes = std::vector<uint8_t>;

constexpr int kSmallPngLevel = 9;
constexpr size_t kPixelBytes = 3;

// Filter types, PNG specification 9.2.
constexpr uint8_t kFilterSub = 1;
constexpr uint8_t kFilterUp = 2;

// A strip deflated into an IDAT chunk, and what the checksum of the zlib stream needs.
struct PngStrip {
  Bytes chunk;
  uint32_t adler;
  size_t filtered_size;
};

void AppendUint32(uint32_t value, Bytes* bytes) {
  for (const int shift : {24, 16, 8, 0}) bytes->push_back(static_cast<uint8_t>(value >> shift));
}

void AppendText(const std::string& text, Bytes* bytes) {
  bytes->insert(bytes->end(), text.begin(), text.end());
}

// Length, type, content, checksum: PNG specification 5.3.
Bytes MakeChunk(const std::string& type, std::span<const uint8_t> content) {
  Bytes chunk;
  chunk.reserve(content.size() + 12);
  AppendUint32(static_cast<uint32_t>(content.size()), &chunk);
  AppendText(type, &chunk);
  chunk.insert(chunk.end(), content.begin(), content.end());
  AppendUint32(crc32_gzip_refl(0, chunk.data() + 4, chunk.size() - 4), &chunk);
  return chunk;
}

void AppendChunk(const std::string& type, std::span<const uint8_t> content, Bytes* bytes) {
  const Bytes chunk = MakeChunk(type, content);
  bytes->insert(bytes->end(), chunk.begin(), chunk.end());
}

// Appends a text. tEXt is Latin-1, so a text that is not ASCII goes to iTXt, without compression
// and language.
void AppendTextChunk(const std::string& keyword, const std::string& value, Bytes* bytes) {
  const bool ascii = std::ranges::all_of(value, [](char c) { return c > 0; });
  Bytes content;
  AppendText(keyword, &content);
  content.insert(content.end(), ascii ? 1 : 5, 0);
  AppendText(value, &content);
  AppendChunk(ascii ? "tEXt" : "iTXt", content, bytes);
}

// The bytes of the file before the first strip.
Bytes MakeHeader(const PngHeader& header) {
  Bytes bytes = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  Bytes content;
  AppendUint32(static_cast<uint32_t>(header.width), &content);
  AppendUint32(static_cast<uint32_t>(header.height), &content);
  // 8 bits, RGB, deflate, adaptive filters, not interlaced.
  content.insert(content.end(), {8, 2, 0, 0, 0});
  AppendChunk("IHDR", content, &bytes);
  // sRGB with perceptual intent. As 11.3.3.5 recommends, gAMA and cHRM repeat it for readers that
  // do not know sRGB: 1/2.2, then x and y of white, red, green, blue, times 100000.
  AppendChunk("sRGB", Bytes{0}, &bytes);
  content.clear();
  AppendUint32(45455, &content);
  AppendChunk("gAMA", content, &bytes);
  content.clear();
  for (const uint32_t v : {31270u, 32900u, 64000u, 33000u, 30000u, 60000u, 15000u, 6000u}) {
    AppendUint32(v, &content);
  }
  AppendChunk("cHRM", content, &bytes);
  for (const auto& [keyword, value] : header.text) AppendTextChunk(keyword, value, &bytes);
  return bytes;
}

// Filters the strip's rows; each begins with its filter type. The first row becomes differences
// from the pixel to the left, so that it does not need another strip, the others differences from
// the row above.
void FilterStrip(const uint8_t* rgb8, size_t rows, size_t row_bytes, uint8_t* out) {
  out[0] = kFilterSub;
  std::memcpy(out + 1, rgb8, kPixelBytes);
  for (size_t i = kPixelBytes; i < row_bytes; ++i) {
    out[1 + i] = static_cast<uint8_t>(rgb8[i] - rgb8[i - kPixelBytes]);
  }
  for (size_t row = 1; row < rows; ++row) {
    const uint8_t* const above = rgb8 + (row - 1) * row_bytes;
    const uint8_t* const here = above + row_bytes;
    uint8_t* const filtered = out + row * (1 + row_bytes);
    filtered[0] = kFilterUp;
    for (size_t i = 0; i < row_bytes; ++i) {
      filtered[1 + i] = static_cast<uint8_t>(here[i] - above[i]);
    }
  }
}

PngHeader HeaderOf(const Rgb8Picture& picture) {
  return {picture.width, picture.height, {{"Software", std::string("nacre ") + kVersion}}};
}

}  // namespace

struct PngWriter::State {
  State(const std::string& path_in, Bytes* memory_in, const PngHeader& header_in,
        const PngOptions& options_in)
      : path(path_in),
        header(header_in),
        options(options_in),
        memory(memory_in),
        in_order([this](size_t, const PngStrip& strip) {
          Append(strip.chunk);
          adler = static_cast<uint32_t>(
              adler32_combine(adler, strip.adler, static_cast<z_off_t>(strip.filtered_size)));
        }) {
    // The deflated bytes of a strip must fit the 31 bits of a chunk's length.
    constexpr int kMaxWidth = std::numeric_limits<int32_t>::max() / (kStripRows * 4);
    if (header.width < 1 || header.height < 1 || header.width > kMaxWidth) {
      throw Error(ExitCode::kInternal, path, "a picture of this size cannot be written as PNG");
    }
    if (memory == nullptr) file.emplace(path);
    Append(MakeHeader(header));
  }

  void Append(std::span<const uint8_t> bytes) {
    if (memory != nullptr) {
      memory->insert(memory->end(), bytes.begin(), bytes.end());
      return;
    }
    file->Write(size, bytes);
    size += bytes.size();
  }
  size_t strip_count() const { return static_cast<size_t>(StripCount(header.height)); }

  PngStrip MakeStrip(size_t index, size_t rows, const uint8_t* rgb8) {
    const Pool<Bytes>::Borrowed filtered = buffers.Borrow();
    const size_t row_bytes = kPixelBytes * static_cast<size_t>(header.width);
    const size_t filtered_size = rows * (1 + row_bytes);
    if (filtered->size() < filtered_size) filtered->resize(filtered_size);
    FilterStrip(rgb8, rows, row_bytes, filtered->data());
    const bool last = index + 1 == strip_count();
    Bytes deflated = Deflate({filtered->data(), filtered_size},
                             last ? DeflateForm::kLastPart : DeflateForm::kPart,
                             options.small          ? kSmallPngLevel
                             : options.reproducible ? kReproducibleDeflate
                                                    : kFastDeflate);
    // The zlib header: deflate with a window of 32 KiB, and check bits.
    if (index == 0) deflated.insert(deflated.begin(), {0x78, 0x01});
    return {MakeChunk("IDAT", deflated), isal_adler32(1, filtered->data(), filtered_size),
            filtered_size};
  }

  const std::string path;
  const PngHeader header;
  const PngOptions options;
  Bytes* const memory;             // where the bytes go; null:
  std::optional<OutputFile> file;  // to this file
  uint64_t size = 0;               // bytes written so far
  uint32_t adler = 1;
  Pool<Bytes> buffers;  // filtered strips
  InOrder<PngStrip> in_order;
};

PngWriter::PngWriter(const std::string& path, const PngHeader& header, const PngOptions& options)
    : state_(std::make_unique<State>(path, nullptr, header, options)) {}

PngWriter::PngWriter(std::vector<uint8_t>* bytes, const PngHeader& header,
                     const PngOptions& options)
    : state_(std::make_unique<State>("PNG", bytes, header, options)) {}

PngWriter::~PngWriter() = default;

void PngWriter::WriteStrip(int y, int rows, const uint8_t* rgb8) {
  const int height = state_->header.height;
  if (y < 0 || y >= height || y % kStripRows != 0 || rows != StripRows(y, height)) {
    throw Error(ExitCode::kInternal, state_->path, "a strip that is not one of the picture's");
  }
  const auto index = static_cast<size_t>(y / kStripRows);
  state_->in_order.Add(index, state_->MakeStrip(index, static_cast<size_t>(rows), rgb8));
}

void PngWriter::WriteAll(std::span<const uint8_t> rgb8) {
  const auto width = static_cast<size_t>(state_->header.width);
  ParallelFor(state_->strip_count(), 0, [&](size_t strip) {
    const int y = static_cast<int>(strip) * kStripRows;
    WriteStrip(y, StripRows(y, state_->header.height),
               rgb8.subspan(kPixelBytes * static_cast<size_t>(y) * width).data());
  });
}

void PngWriter::WriteAll(
    const std::function<void(size_t first, size_t count, uint8_t* rgb8)>& encode) {
  const auto width = static_cast<size_t>(state_->header.width);
  ParallelFor(state_->strip_count(), 0, [&](size_t strip) {
    const int y = static_cast<int>(strip) * kStripRows;
    const int rows = StripRows(y, state_->header.height);
    const size_t count = static_cast<size_t>(rows) * width;
    Bytes rgb8(kPixelBytes * count);
    encode(static_cast<size_t>(y) * width, count, rgb8.data());
    WriteStrip(y, rows, rgb8.data());
  });
}

void PngWriter::Finish(const PngText& text) {
  if (state_->in_order.count() != state_->strip_count()) {
    throw Error(ExitCode::kInternal, state_->path, "the picture is not complete");
  }
  // The checksum of the zlib stream is in a last IDAT of its own, because the strips were already
  // in chunks when it was not known yet.
  Bytes content;
  AppendUint32(state_->adler, &content);
  Bytes end = MakeChunk("IDAT", content);
  for (const auto& [keyword, value] : text) AppendTextChunk(keyword, value, &end);
  AppendChunk("IEND", {}, &end);
  state_->Append(end);
  if (state_->file) state_->file->Commit(state_->options.sync);
}

void WritePng(const std::string& path, const Rgb8Picture& picture, const PngOptions& options) {
  PngWriter writer(path, HeaderOf(picture), options);
  writer.WriteAll(picture.rgb8);
  writer.Finish();
}

std::vector<uint8_t> EncodePng(const Rgb8Picture& picture, const PngOptions& options) {
  std::vector<uint8_t> bytes;
  PngWriter writer(&bytes, HeaderOf(picture), options);
  writer.WriteAll(picture.rgb8);
  writer.Finish();
  return bytes;
}

}  // namespace nacre
