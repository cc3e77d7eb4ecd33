// SPDX-License-Identifier: Apache-2.0
#include "image_io/exr_writer.h"

#include <algorithm>
#include <atomic>
#include <map>
#include <mutex>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/parallel.h"
#include "base/pool.h"
#include "image_io/deflate.h"
#include "image_io/exr_chunk.h"
#include "image_io/exr_container.h"
#include "image_io/in_order.h"

namespace nacre {
namespace {

// zlib's default is used for --small: level 9 takes twice as long to save one per cent.
constexpr int kSmallExrLevel = 6;

struct Chunk {
  int y;
  std::vector<uint8_t> bytes;
};

// A unit of writing: the chunks of one strip, or the one chunk of two strips.
using Chunks = std::vector<Chunk>;

// A chunk of two strips, before both have come.
struct Gathered {
  std::vector<uint16_t> words;
  std::set<int> strips;  // the first rows of the strips that have come
  int rows = 0;
};

}  // namespace

struct ExrWriter::State {
  State(const std::string& path_in, std::vector<uint8_t>* memory, const ExrHeader& header,
        const ExrOptions& options_in)
      : path(path_in),
        data(header.data),
        options(options_in),
        layout(MakeExrLayout(path_in, header)),
        container(path_in, memory, header, options_in.compression),
        in_order([this](size_t, const Chunks& chunks) {
          for (const Chunk& chunk : chunks) container.WriteChunk(chunk.y, chunk.bytes);
        }) {}

  void CheckStrip(const StripView& strip) const {
    const int y = strip.y - data.y0;
    if (y < 0 || y >= data.height() || y % kStripRows != 0 ||
        strip.rows != StripRows(y, data.height()) ||
        strip.channels.size() != layout.channels.size()) {
      throw Error(ExitCode::kInternal, path, "a strip that is not one of the picture's");
    }
  }

  size_t unit_count() const {
    const int rows = unit_rows();
    return static_cast<size_t>((data.height() + rows - 1) / rows);
  }
  // The rows of a unit of writing.
  int unit_rows() const { return std::max(kStripRows, RowsPerChunk(options.compression)); }

  Chunks CompressStrip(const StripView& strip, std::span<const uint16_t> words) const {
    const int level = options.small          ? kSmallExrLevel
                      : options.reproducible ? kReproducibleDeflate
                                             : kFastDeflate;
    if (options.compression == Compression::kZip) return {{strip.y, CompressZip(words, level)}};
    Chunks chunks;
    for (int row = 0; row < strip.rows; ++row) {
      const auto row_words =
          words.subspan(static_cast<size_t>(row) * layout.row_words, layout.row_words);
      const bool zips = options.compression == Compression::kZips;
      chunks.push_back(
          {strip.y + row, zips ? CompressZip(row_words, level) : StoreWords(row_words)});
    }
    return chunks;
  }

  // For chunks of two strips: the thread that brings the second strip compresses both.
  void Gather(const StripView& strip, std::span<const uint16_t> words) {
    const int y = strip.y - data.y0;
    const int first_row = y / unit_rows() * unit_rows();
    const int rows = std::min(unit_rows(), data.height() - first_row);
    const auto unit = static_cast<size_t>(y / unit_rows());
    Gathered complete;
    {
      const std::lock_guard lock(gather_mutex);
      Gathered& partial = gathered[unit];
      if (!partial.strips.insert(y).second) {
        throw Error(ExitCode::kInternal, path, "a strip came twice");
      }
      partial.words.resize(static_cast<size_t>(rows) * layout.row_words);
      const size_t offset = static_cast<size_t>(y - first_row) * layout.row_words;
      std::ranges::copy(words, partial.words.begin() + static_cast<ptrdiff_t>(offset));
      partial.rows += strip.rows;
      if (partial.rows < rows) return;
      complete = std::move(partial);
      gathered.erase(unit);
    }
    in_order.Add(unit, {{data.y0 + first_row,
                         CompressByLibrary(layout, options.compression, complete.words)}});
  }

  const std::string path;
  const Window data;
  const ExrOptions options;
  const ExrLayout layout;
  ExrContainer container;
  InOrder<Chunks> in_order;
  Pool<std::vector<uint16_t>> scratch;  // packed strips
  std::mutex gather_mutex;
  std::map<size_t, Gathered> gathered;  // by unit
  std::atomic<uint64_t> clamped = 0, infinite = 0, nan = 0;
};

ExrWriter::ExrWriter(const std::string& path, const ExrHeader& header, const ExrOptions& options)
    : state_(std::make_unique<State>(path, nullptr, header, options)) {}

ExrWriter::ExrWriter(std::vector<uint8_t>* bytes, const ExrHeader& header,
                     const ExrOptions& options)
    : state_(std::make_unique<State>("EXR", bytes, header, options)) {}

ExrWriter::~ExrWriter() = default;

void ExrWriter::WriteStrip(const StripView& strip) {
  state_->CheckStrip(strip);
  const auto scratch = state_->scratch.Borrow();
  const size_t size = static_cast<size_t>(strip.rows) * state_->layout.row_words;
  if (scratch->size() < size) scratch->resize(size);
  const std::span words(scratch->data(), size);
  const SampleCounts counts = PackRows(state_->layout, strip, words.data());
  state_->clamped += counts.clamped;
  state_->infinite += counts.infinite;
  state_->nan += counts.nan;
  if (state_->unit_rows() == kStripRows) {
    const auto index = static_cast<size_t>((strip.y - state_->data.y0) / kStripRows);
    state_->in_order.Add(index, state_->CompressStrip(strip, words));
  } else {
    state_->Gather(strip, words);
  }
}

void ExrWriter::WriteAll(const std::vector<const float*>& planes) {
  const Window& data = state_->data;
  ParallelFor(static_cast<size_t>(StripCount(data.height())), 0, [&](size_t index) {
    const int row = static_cast<int>(index) * kStripRows;
    StripView strip{data.y0 + row, StripRows(row, data.height()), {}};
    for (const float* plane : planes) {
      strip.channels.emplace_back(plane + static_cast<size_t>(row) * state_->layout.width);
    }
    WriteStrip(strip);
  });
}

void ExrWriter::UpdateAttribute(const std::string& name, const ExrAttribute& value) {
  state_->container.UpdateAttribute(name, value);
}

void ExrWriter::Finish() {
  if (state_->in_order.count() != state_->unit_count()) {
    throw Error(ExitCode::kInternal, state_->path, "the picture is not complete");
  }
  state_->container.Finish(state_->options.sync);
}

SampleCounts ExrWriter::counts() const { return {state_->clamped, state_->infinite, state_->nan}; }

}  // namespace nacre
