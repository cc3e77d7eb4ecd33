// SPDX-License-Identifier: Apache-2.0
// tests/image_io/deflate_test.cc: deflate, undone by zlib.
#include "image_io/deflate.h"

#include <algorithm>
#include <random>

#include <zlib.h>

#include "catch.h"

namespace nacre {
namespace {

constexpr int kLevels[] = {kFastDeflate, 6, 9};

// Bytes with repetitions, or with none.
std::vector<uint8_t> MakeBytes(size_t size, bool noise, unsigned seed) {
  std::mt19937 random(seed);
  const size_t period = 3 + random() % 90;
  std::vector<uint8_t> bytes(size);
  for (size_t i = 0; i < size; ++i) {
    bytes[i] = static_cast<uint8_t>(noise ? random() : i % period / 3);
  }
  return bytes;
}

// What `deflated` inflates to, at most `size` bytes; window_bits as inflateInit2 has it.
std::vector<uint8_t> Inflate(std::vector<uint8_t> deflated, size_t size, int window_bits) {
  std::vector<uint8_t> bytes(size + 1);
  z_stream stream{};
  REQUIRE(inflateInit2(&stream, window_bits) == Z_OK);
  stream.next_in = deflated.data();
  stream.avail_in = static_cast<uInt>(deflated.size());
  stream.next_out = bytes.data();
  stream.avail_out = static_cast<uInt>(bytes.size());
  CHECK(inflate(&stream, Z_FINISH) == Z_STREAM_END);
  CHECK(stream.avail_in == 0);
  bytes.resize(stream.total_out);
  inflateEnd(&stream);
  return bytes;
}

TEST_CASE("whole streams inflate to what they were") {
  for (const int level : kLevels) {
    for (const bool noise : {false, true}) {
      for (const size_t size : {1u, 2u, 7u, 64u, 1000u, 65535u, 65536u, 500000u}) {
        CAPTURE(level, noise, size);
        const std::vector<uint8_t> bytes = MakeBytes(size, noise, 1);
        CHECK(Inflate(Deflate(bytes, DeflateForm::kZlib, level), size, MAX_WBITS) == bytes);
      }
    }
  }
}

TEST_CASE("parts make one stream") {
  for (const int level : kLevels) {
    CAPTURE(level);
    std::vector<uint8_t> bytes;
    std::vector<uint8_t> stream;
    for (unsigned i = 0; i < 20; ++i) {
      const std::vector<uint8_t> part = MakeBytes(1 + 997 * i, i % 5 == 4, i);
      const DeflateForm form = i == 19 ? DeflateForm::kLastPart : DeflateForm::kPart;
      const std::vector<uint8_t> deflated = Deflate(part, form, level);
      bytes.insert(bytes.end(), part.begin(), part.end());
      stream.insert(stream.end(), deflated.begin(), deflated.end());
    }
    CHECK(Inflate(stream, bytes.size(), -MAX_WBITS) == bytes);
  }
}

// Leaves `value` in the stack below its caller, where Deflate's variables come to lie.
[[gnu::noinline]] void DirtyStack(uint16_t value) {
  uint16_t words[150000];
  std::ranges::fill(words, value);
  asm volatile("" : : "r"(words) : "memory");  // the compiler must not leave it out
}

// Two renders of one picture are the same file, whatever was done before.
TEST_CASE("the result depends on the input only") {
  constexpr DeflateForm kForms[] = {DeflateForm::kZlib, DeflateForm::kPart, DeflateForm::kLastPart};
  const std::vector<uint8_t> bytes = MakeBytes(5000, false, 1);
  for (const DeflateForm form : kForms) {
    DirtyStack(0);
    const std::vector<uint8_t> expected = Deflate(bytes, form, kFastDeflate);
    for (const uint16_t dirt :
         std::vector<uint16_t>{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 15, 257, 65535}) {
      CAPTURE(dirt);
      DirtyStack(dirt);
      CHECK(Deflate(bytes, form, kFastDeflate) == expected);
    }
  }
}

}  // namespace
}  // namespace nacre
