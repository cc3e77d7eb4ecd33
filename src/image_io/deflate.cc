// SPDX-License-Identifier: Apache-2.0
#include "image_io/deflate.h"

#include <isa-l/igzip_lib.h>
#include <zlib.h>

#include "base/error.h"
#include "base/pool.h"

namespace nacre {
namespace {

// Buffers for the result and for ISA-L's tables, kept for the next strip: one needs half a
// megabyte, and allocating that anew costs as much as deflating into it.
struct Scratch {
  std::vector<uint8_t> result;
  std::vector<uint8_t> tables = std::vector<uint8_t>(ISAL_DEF_LVL1_DEFAULT);
};

Pool<Scratch>::Borrowed BorrowScratch() {
  static Pool<Scratch> pool;
  return pool.Borrow();
}

[[noreturn]] void Fail() { throw Error(ExitCode::kInternal, "deflate", "did not fit its bound"); }

size_t FastDeflate(std::span<const uint8_t> bytes, DeflateForm form, Scratch* scratch) {
  isal_zstream stream;
  isal_deflate_stateless_init(&stream);
  stream.hist_bits = 0;  // the widest window; the line above leaves it uninitialised
  stream.level = kFastDeflate;
  stream.level_buf = scratch->tables.data();
  stream.level_buf_size = static_cast<uint32_t>(scratch->tables.size());
  stream.gzip_flag = form == DeflateForm::kZlib ? IGZIP_ZLIB : IGZIP_DEFLATE;
  stream.flush = form == DeflateForm::kPart ? FULL_FLUSH : NO_FLUSH;
  stream.end_of_stream = form == DeflateForm::kPart ? 0 : 1;
  stream.next_in = const_cast<uint8_t*>(bytes.data());  // only read
  stream.avail_in = static_cast<uint32_t>(bytes.size());
  stream.next_out = scratch->result.data();
  stream.avail_out = static_cast<uint32_t>(scratch->result.size());
  if (isal_deflate_stateless(&stream) != COMP_OK || stream.avail_in != 0) Fail();
  return stream.total_out;
}

size_t SmallDeflate(std::span<const uint8_t> bytes, DeflateForm form, int level, Scratch* scratch) {
  constexpr int kMemoryLevel = 9;
  const int window_bits = form == DeflateForm::kZlib ? MAX_WBITS : -MAX_WBITS;  // < 0: raw
  z_stream stream{};
  if (deflateInit2(&stream, level, Z_DEFLATED, window_bits, kMemoryLevel, Z_DEFAULT_STRATEGY) !=
      Z_OK) {
    throw std::bad_alloc();
  }
  stream.next_in = const_cast<uint8_t*>(bytes.data());  // only read
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = scratch->result.data();
  stream.avail_out = static_cast<uInt>(scratch->result.size());
  const int result = deflate(&stream, form == DeflateForm::kPart ? Z_FULL_FLUSH : Z_FINISH);
  const size_t size = stream.total_out;
  const bool complete = stream.avail_in == 0 && stream.avail_out != 0;
  deflateEnd(&stream);
  if (result != (form == DeflateForm::kPart ? Z_OK : Z_STREAM_END) || !complete) Fail();
  return size;
}

}  // namespace

std::vector<uint8_t> Deflate(std::span<const uint8_t> bytes, DeflateForm form, int level) {
  // Incompressible bytes are stored in blocks, each with a header, plus the header of the stream.
  const size_t bound = compressBound(bytes.size()) + 512;
  const Pool<Scratch>::Borrowed scratch = BorrowScratch();
  std::vector<uint8_t>& result = scratch->result;
  if (result.size() < bound) result.resize(bound);
  const size_t size = level == kFastDeflate ? FastDeflate(bytes, form, scratch.get())
                                            : SmallDeflate(bytes, form, level, scratch.get());
  return {result.begin(), result.begin() + static_cast<ptrdiff_t>(size)};
}

}  // namespace nacre
