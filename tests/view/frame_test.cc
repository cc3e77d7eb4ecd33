// SPDX-License-Identifier: Apache-2.0
// view/frame_test.cc: what is sent of a picture, and that it makes the picture.
#include "view/frame.h"

#include <algorithm>
#include <cstring>
#include <vector>

#include "catch.h"

namespace nacre {
namespace {

using Pixels = std::vector<uint32_t>;

SharedBytes Message(uint32_t width, uint32_t height, const Pixels& pixels) {
  FrameHead head;
  head.width = head.part_width = width;
  head.height = head.part_height = height;
  auto bytes = std::make_shared<std::vector<uint8_t>>(kFrameHeadBytes + 4 * pixels.size());
  std::memcpy(bytes->data(), &head, kFrameHeadBytes);
  std::memcpy(bytes->data() + kFrameHeadBytes, pixels.data(), 4 * pixels.size());
  return bytes;
}

// Puts a piece's pixels into the picture; returns how many there are.
size_t Put(const std::vector<uint8_t>& piece, Pixels* picture) {
  const FrameHead head = HeadOf(piece);
  const size_t count = size_t{head.part_width} * head.part_height;
  REQUIRE(piece.size() == kFrameHeadBytes + 4 * count);
  for (size_t i = 0; i < count; ++i) {
    const size_t x = head.part_x + i % head.part_width, y = head.part_y + i / head.part_width;
    REQUIRE(x < head.width);
    REQUIRE(y < head.height);
    std::memcpy(&(*picture)[y * head.width + x], piece.data() + kFrameHeadBytes + 4 * i, 4);
  }
  return count;
}

TEST_CASE("pieces of what has changed make the picture") {
  constexpr uint32_t kWidth = 7, kHeight = 5;
  struct Change {
    std::vector<size_t> at;
    size_t sent;  // pixels of the rectangle around them
  };
  const std::vector<Change> changes = {{{}, 0},      {{0}, 1},     {{6}, 1},
                                       {{28}, 1},    {{34}, 1},    {{0, 34}, 35},
                                       {{9, 16}, 2}, {{9, 12}, 4}, {{10, 15, 17, 24}, 9},
                                       {{20, 7}, 14}};
  const Pixels before(kWidth * kHeight, 7);
  for (const Change& change : changes) {
    Pixels now = before;
    for (const size_t at : change.at) now[at] ^= 0x01000000U << (at % 3);
    for (const size_t piece_bytes : {size_t{1}, size_t{60}, size_t{10000}}) {
      const SharedBytes first = Message(kWidth, kHeight, before);
      const PicturePieces pieces(first.get(), Message(kWidth, kHeight, now), piece_bytes);
      Pixels seen = before;
      size_t sent = 0;
      for (uint32_t i = 0; i < pieces.count(); ++i) {
        const SharedBytes piece = pieces.Piece(i);
        CHECK(HeadOf(*piece).piece == i);
        CHECK(HeadOf(*piece).pieces == pieces.count());
        CHECK(HeadOf(*piece).part_width * 4 <= std::max<size_t>(piece_bytes, 4 * kWidth));
        sent += Put(*piece, &seen);
      }
      CHECK(seen == now);
      CHECK(sent == change.sent);
    }
  }
}

TEST_CASE("pictures of another size, and the first, are sent whole") {
  const Pixels now(12, 3);
  for (const SharedBytes& before : {SharedBytes(), Message(2, 6, Pixels(12, 3))}) {
    const PicturePieces pieces(before.get(), Message(4, 3, now), 16);
    CHECK(pieces.count() == 3);
    Pixels seen(12);
    for (uint32_t i = 0; i < pieces.count(); ++i) Put(*pieces.Piece(i), &seen);
    CHECK(seen == now);
  }
}

}  // namespace
}  // namespace nacre
