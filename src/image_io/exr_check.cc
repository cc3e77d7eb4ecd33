// SPDX-License-Identifier: Apache-2.0
#include "image_io/exr_check.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <isa-l/igzip_lib.h>
#include <openexr.h>
#include <zlib.h>

#include "base/error.h"
#include "base/huge_pages.h"
#include "base/parallel.h"
#include "image_io/image_file.h"

namespace nacre {
namespace {

[[noreturn]] void FailExr(const std::string& path, const std::string& what) {
  throw Error(ExitCode::kBadInput, path, "cannot be read as EXR: " + what);
}

// Whether the file is at least as long as its chunk tables, 8 bytes per chunk, for which the C++
// reader allocates memory.
bool HasRoomForTables(exr_const_context_t context, const std::string& path) {
  int parts = 0;
  if (exr_get_count(context, &parts) != EXR_ERR_SUCCESS) return false;
  uint64_t chunks = 0;
  for (int part = 0; part < parts; ++part) {
    int32_t count = 0;
    if (exr_get_chunk_count(context, part, &count) != EXR_ERR_SUCCESS || count < 0) return false;
    chunks += static_cast<uint64_t>(count);
  }
  std::error_code error;
  return chunks * sizeof(uint64_t) <= std::filesystem::file_size(path, error) && !error;
}

// The first error that OpenEXR's C library reports about the header. Its C++ reader allocates as
// much memory as an attribute claims to have, 2 GiB of text in a file of 40 bytes. The C library
// compares the size with that of the file and reports an error, but then continues; so any report
// counts.
exr_result_t FirstComplaint(const std::string& path) {
  exr_result_t complaint = EXR_ERR_SUCCESS;
  exr_context_initializer_t initializer = EXR_DEFAULT_CONTEXT_INITIALIZER;
  initializer.user_data = &complaint;
  initializer.error_handler_fn = [](exr_const_context_t context, exr_result_t code, const char*) {
    void* first = nullptr;
    if (exr_get_user_data(context, &first) != EXR_ERR_SUCCESS || first == nullptr) return;
    if (auto* const kept = static_cast<exr_result_t*>(first); *kept == EXR_ERR_SUCCESS)
      *kept = code;
  };
  exr_context_t context = nullptr;
  exr_result_t result = exr_start_read(&context, path.c_str(), &initializer);
  if (result == EXR_ERR_SUCCESS && !HasRoomForTables(context, path)) {
    result = EXR_ERR_FILE_BAD_HEADER;
  }
  exr_finish(&context);
  return complaint != EXR_ERR_SUCCESS ? complaint : result;
}

// Whether a list of channels, which have a name and 16 bytes each, ends with an empty name exactly
// at its end.
bool EndsWhereItSays(std::string_view list) {
  constexpr size_t kDescription = 16;
  while (!list.empty()) {
    const size_t end = list.find('\0');
    if (end == 0) return list.size() == 1;
    if (end == std::string_view::npos || list.size() <= end + kDescription) return false;
    list.remove_prefix(end + 1 + kDescription);
  }
  return false;
}

// The C++ reader continues after the last channel's name instead of after the attribute's size, and
// takes what is there for an attribute. Here, sizes have been checked to lie within the file.
bool ChannelListsEnd(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  constexpr std::streamoff kMagic = 4;
  constexpr uint32_t kMultiPart = 0x1000;
  uint32_t version = 0;
  file.seekg(kMagic).read(reinterpret_cast<char*>(&version), sizeof(version));
  bool after_header = false;  // a second empty name ends the headers of a multi-part file
  std::string name, type, value;
  while (std::getline(file, name, '\0')) {
    if (name.empty()) {
      if ((version & kMultiPart) == 0 || after_header) return true;
      after_header = true;
      continue;
    }
    after_header = false;
    int32_t size = 0;
    if (!std::getline(file, type, '\0') ||
        !file.read(reinterpret_cast<char*>(&size), sizeof(size)) || size < 0) {
      return false;
    }
    if (type != "chlist") {
      file.seekg(size, std::ios::cur);
      continue;
    }
    value.resize(static_cast<size_t>(size));
    if (!file.read(value.data(), size) || !EndsWhereItSays(value)) return false;
  }
  return false;
}

// A file opened for reading chunks. The library also reports errors in its result codes, so its
// message handler does nothing.
class ChunkFile {
 public:
  explicit ChunkFile(const std::string& path) : path_(path) {
    exr_context_initializer_t initializer = EXR_DEFAULT_CONTEXT_INITIALIZER;
    initializer.error_handler_fn = [](exr_const_context_t, exr_result_t, const char*) {};
    // A chunk table with holes means that the file's writer was stopped: do not rebuild it.
    initializer.flags = EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION;
    Check(exr_start_read(&context_, path.c_str(), &initializer), "its header");
  }
  ~ChunkFile() { exr_finish(&context_); }
  ChunkFile(const ChunkFile&) = delete;
  ChunkFile& operator=(const ChunkFile&) = delete;

  exr_const_context_t get() const { return context_; }
  void Check(exr_result_t result, const std::string& what) const {
    if (result == EXR_ERR_SUCCESS) return;
    FailExr(path_, what + ": " + exr_get_default_error_message(result));
  }

 private:
  std::string path_;
  exr_context_t context_ = nullptr;
};

// The number of bytes that the zlib stream inflates to, limit + 1 if there are more; 0 for a broken
// stream.
uint64_t InflatedSize(std::span<const uint8_t> packed, uint64_t limit) {
  z_stream stream{};
  if (inflateInit(&stream) != Z_OK) throw std::bad_alloc();
  stream.next_in = const_cast<uint8_t*>(packed.data());
  stream.avail_in = static_cast<uInt>(packed.size());
  std::vector<uint8_t> room(size_t{1} << 16);
  uint64_t size = 0;
  int status = Z_OK;
  while (status == Z_OK && size <= limit) {
    stream.next_out = room.data();
    stream.avail_out = static_cast<uInt>(room.size());
    status = inflate(&stream, Z_NO_FLUSH);
    size += room.size() - stream.avail_out;
  }
  inflateEnd(&stream);
  return status == Z_STREAM_END ? size : size > limit ? limit + 1 : 0;
}

// The number of bytes that OpenEXR's run-length encoding decodes to: a code -n is followed by n
// literal bytes, a code n by a byte that occurs n + 1 times. 0 if the last run is cut off.
uint64_t RunsSize(std::span<const uint8_t> packed) {
  uint64_t size = 0;
  size_t i = 0;
  while (i < packed.size()) {
    const auto code = static_cast<int8_t>(packed[i]);
    const size_t count = code < 0 ? static_cast<size_t>(-int{code}) : static_cast<size_t>(code) + 1;
    i += 1 + (code < 0 ? count : 1);
    if (i > packed.size()) return 0;
    size += count;
  }
  return size;
}

// Inflates a chunk, faster than zlib does. Returns false if it is not whole; InflatedSize finds out
// why.
bool InflateWhole(std::span<const uint8_t> packed, std::span<uint8_t> unpacked) {
  inflate_state state;
  isal_inflate_init(&state);
  state.crc_flag = ISAL_ZLIB;
  state.next_in = const_cast<uint8_t*>(packed.data());  // only read
  state.avail_in = static_cast<uint32_t>(packed.size());
  state.next_out = unpacked.data();
  state.avail_out = static_cast<uint32_t>(unpacked.size());
  return isal_inflate_stateless(&state) == ISAL_DECOMP_OK && state.total_out == unpacked.size();
}

// Undoes SplitAndPredict (image_io/exr_chunk.h). `bytes` holds 2 * words.size().
void JoinPredicted(std::span<const uint8_t> bytes, std::span<uint16_t> words) {
  constexpr uint32_t kOffset = 128;  // adding and subtracting it are the same modulo 256
  const size_t count = words.size();
  const uint8_t* const even = bytes.data();
  const uint8_t* const odd = even + count;
  // The odd bytes continue the prediction where the even ones end: starting them from the sum of
  // the even bytes allows decoding both side by side.
  uint32_t sum = 0;
  for (size_t i = 0; i < count; ++i) sum += even[i];
  uint32_t low = kOffset;
  uint32_t high = kOffset + sum + static_cast<uint32_t>(count % 2) * kOffset;
  for (size_t i = 0; i < count; ++i) {
    low += even[i] + kOffset;
    high += odd[i] + kOffset;
    words[i] = static_cast<uint16_t>((low & 0xff) | (high & 0xff) << 8);
  }
}

void CheckChunk(const std::string& path, const ChunkFile& file, int part,
                const exr_chunk_info_t& chunk, const std::string& name) {
  if (chunk.packed_size > chunk.unpacked_size) {
    FailExr(path, name + " is longer than what it holds");
  }
  const bool has_runs = chunk.compression == EXR_COMPRESSION_RLE;
  const bool is_deflated =
      chunk.compression == EXR_COMPRESSION_ZIP || chunk.compression == EXR_COMPRESSION_ZIPS;
  uint64_t size = chunk.packed_size;
  if (has_runs || is_deflated) {
    std::vector<uint8_t> packed(chunk.packed_size);
    file.Check(exr_read_chunk(file.get(), part, &chunk, packed.data()), name);
    if (size != chunk.unpacked_size) {  // else it is stored: packing did not make it shorter
      size = has_runs ? RunsSize(packed) : InflatedSize(packed, chunk.unpacked_size);
    }
  } else if (chunk.compression != EXR_COMPRESSION_NONE) {
    return;  // other compressions detect short data themselves
  }
  if (size == chunk.unpacked_size) return;
  FailExr(path,
          fmt::format("{} holds {} bytes of samples, not {}", name, size, chunk.unpacked_size));
}

// The chunks of a part that consists of scanlines.
struct Lines {
  int64_t first = 0, rows_per_chunk = 1, height = 0;

  int64_t chunk_count() const { return (height + rows_per_chunk - 1) / rows_per_chunk; }
};

// Calls check(chunk, name) for each chunk of scanlines, in parallel.
void ForEachChunk(
    const ChunkFile& file, int part, const Lines& lines,
    const std::function<void(const exr_chunk_info_t& chunk, const std::string& name)>& check) {
  ParallelFor(static_cast<size_t>(lines.chunk_count()), 0, [&](size_t i) {
    const int64_t y = lines.first + static_cast<int64_t>(i) * lines.rows_per_chunk;
    const std::string name = fmt::format("the chunk of row {}", y);
    exr_chunk_info_t chunk{};
    file.Check(exr_read_scanline_chunk_info(file.get(), part, static_cast<int>(y), &chunk), name);
    check(chunk, name);
  });
}

// Throws if the file is shorter than its chunk table, which takes 8 bytes per chunk.
void CheckTable(const std::string& path, uint64_t file_bytes, int64_t columns, int64_t rows) {
  if (static_cast<double>(columns) * static_cast<double>(rows) * 8 >
      static_cast<double>(file_bytes)) {
    FailExr(path, "it is too short for its table of chunks");
  }
}

Lines CheckLines(const std::string& path, const ChunkFile& file, int part, uint64_t file_bytes,
                 const exr_attr_box2i_t& box, uint64_t channels) {
  int32_t rows = 1;
  file.Check(exr_get_scanlines_per_chunk(file.get(), part, &rows), "lines");
  const Lines lines = {box.min.y, std::max(rows, 1), int64_t{box.max.y} - box.min.y + 1};
  CheckSampleCount(path + ": chunks", file_bytes, int64_t{box.max.x} - box.min.x + 1,
                   std::min(lines.rows_per_chunk, lines.height), channels);
  CheckTable(path, file_bytes, 1, lines.chunk_count());
  return lines;
}

struct PartHeader {
  exr_storage_t storage = EXR_STORAGE_SCANLINE;
  exr_compression_t compression = EXR_COMPRESSION_NONE;
  exr_attr_box2i_t data_window{};
  uint64_t channels = 0;
};

PartHeader DescribePart(const ChunkFile& file, int part) {
  PartHeader header;
  const exr_attr_chlist_t* channels = nullptr;
  file.Check(exr_get_storage(file.get(), part, &header.storage), "a part");
  file.Check(exr_get_compression(file.get(), part, &header.compression), "a compression");
  file.Check(exr_get_data_window(file.get(), part, &header.data_window), "a data window");
  file.Check(exr_get_channels(file.get(), part, &channels), "channels");
  header.channels = static_cast<uint64_t>(channels->num_channels);
  return header;
}

}  // namespace

void CheckExrHeader(const std::string& path) {
  const exr_result_t complaint = FirstComplaint(path);
  if (complaint != EXR_ERR_SUCCESS) FailExr(path, exr_get_default_error_message(complaint));
  if (!ChannelListsEnd(path)) FailExr(path, "its list of channels is not as long as it says");
}

void CheckExrChunks(const std::string& path, int part, uint64_t file_bytes) {
  const ChunkFile file(path);
  const auto [storage, compression, box, channel_count] = DescribePart(file, part);
  const int64_t width = int64_t{box.max.x} - box.min.x + 1;
  const int64_t height = int64_t{box.max.y} - box.min.y + 1;
  if (storage == EXR_STORAGE_TILED) {
    uint32_t tile_width = 0, tile_height = 0;
    exr_tile_level_mode_t levels{};
    exr_tile_round_mode_t rounding{};
    file.Check(
        exr_get_tile_descriptor(file.get(), part, &tile_width, &tile_height, &levels, &rounding),
        "tiles");
    if (tile_width == 0 || tile_height == 0) FailExr(path, "its tiles are empty");
    // OpenEXR's reader keeps a row of tiles, and a tile.
    CheckSampleCount(path + ": tiles", file_bytes, std::max<int64_t>(width, tile_width),
                     tile_height, channel_count);
    const int64_t columns = (width + tile_width - 1) / tile_width;
    const int64_t rows = (height + tile_height - 1) / tile_height;
    CheckTable(path, file_bytes, columns, rows);
    ParallelFor(static_cast<size_t>(columns * rows), 0, [&](size_t i) {
      const int x = static_cast<int>(static_cast<int64_t>(i) % columns);
      const int y = static_cast<int>(static_cast<int64_t>(i) / columns);
      const std::string name = fmt::format("tile {}, {}", x, y);
      exr_chunk_info_t chunk{};
      file.Check(exr_read_tile_chunk_info(file.get(), part, x, y, 0, 0, &chunk), name);
      CheckChunk(path, file, part, chunk, name);
    });
    return;
  }
  ForEachChunk(file, part, CheckLines(path, file, part, file_bytes, box, channel_count),
               [&](const exr_chunk_info_t& chunk, const std::string& name) {
                 CheckChunk(path, file, part, chunk, name);
               });
}

bool DecodeExrLines(const std::string& path, int part, uint64_t file_bytes,
                    const std::function<void(const ExrChunkRows&)>& use) {
  const ChunkFile file(path);
  const auto [storage, compression, box, channel_count] = DescribePart(file, part);
  const bool is_deflated =
      compression == EXR_COMPRESSION_ZIP || compression == EXR_COMPRESSION_ZIPS;
  if (storage != EXR_STORAGE_SCANLINE || !is_deflated) return false;
  const Lines lines = CheckLines(path, file, part, file_bytes, box, channel_count);
  ForEachChunk(file, part, lines, [&](const exr_chunk_info_t& chunk, const std::string& name) {
    if (chunk.packed_size > chunk.unpacked_size) CheckChunk(path, file, part, chunk, name);
    HugeArray<uint8_t> packed(chunk.packed_size);
    file.Check(exr_read_chunk(file.get(), part, &chunk, packed.data()), name);
    HugeArray<uint16_t> words(chunk.unpacked_size / 2);
    if (packed.size() == chunk.unpacked_size) {  // stored: deflate did not make it shorter
      std::memcpy(words.data(), packed.data(), packed.size());
    } else {
      HugeArray<uint8_t> bytes(chunk.unpacked_size);
      if (!InflateWhole({packed.data(), packed.size()}, {bytes.data(), bytes.size()})) {
        CheckChunk(path, file, part, chunk, name);
        FailExr(path, name + " is damaged");
      }
      JoinPredicted({bytes.data(), bytes.size()}, {words.data(), words.size()});
    }
    use({chunk.start_y, chunk.height, {words.data(), words.size()}});
  });
  return true;
}

}  // namespace nacre
