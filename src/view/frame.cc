// SPDX-License-Identifier: Apache-2.0
#include "view/frame.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "base/parallel.h"

namespace nacre {
namespace {

static_assert(sizeof(FrameHead) == kFrameHeadBytes);

std::shared_ptr<std::vector<uint8_t>> WithHead(const FrameHead& head, size_t bytes) {
  auto message = std::make_shared<std::vector<uint8_t>>(kFrameHeadBytes + bytes);
  std::memcpy(message->data(), &head, kFrameHeadBytes);
  return message;
}

// Sets the part in a picture's head to the bounding rectangle of the differing pixels; empty if
// there are none.
void FindChange(const uint8_t* before, const uint8_t* now, FrameHead* head) {
  const size_t row_bytes = size_t{4} * head->width;
  uint32_t top = head->height, bottom = 0, left = head->width, right = 0;
  for (uint32_t y = 0; y < head->height; ++y) {
    const uint8_t *const a = before + y * row_bytes, *const b = now + y * row_bytes;
    if (std::memcmp(a, b, row_bytes) == 0) continue;
    const auto same = [&](size_t x) { return std::memcmp(a + 4 * x, b + 4 * x, 4) == 0; };
    top = std::min(top, y);
    bottom = y + 1;
    uint32_t x = 0, end = head->width;
    while (x < left && same(x)) ++x;
    while (end > right && same(end - 1)) --end;
    left = std::min(left, x);
    right = std::max(right, end);
  }
  head->part_x = bottom > 0 ? left : 0;
  head->part_y = bottom > 0 ? top : 0;
  head->part_width = bottom > 0 ? right - left : 0;
  head->part_height = bottom > 0 ? bottom - top : 0;
}

}  // namespace

SharedBytes PictureBytes(FrameHead head, const std::array<const float*, 3>& rgb,
                         const DisplaySettings& display) {
  const size_t pixels = size_t{head.width} * head.height;
  head.kind = 1;
  head.part_width = head.width;
  head.part_height = head.height;
  const auto message = WithHead(head, 4 * pixels);
  uint8_t* const rgba = message->data() + kFrameHeadBytes;
  constexpr size_t kBlock = size_t{1} << 13;
  ParallelForBlocks(pixels, kBlock, 0, [&](size_t first, size_t end) {
    std::array<uint8_t, 3 * kBlock> rgb8;
    EncodeDisplay(display, rgb[0] + first, rgb[1] + first, rgb[2] + first, end - first,
                  rgb8.data());
    for (size_t i = first; i < end; ++i) {
      std::memcpy(rgba + 4 * i, &rgb8[3 * (i - first)], 3);
      rgba[4 * i + 3] = 255;
    }
  });
  return message;
}

FrameHead HeadOf(const std::vector<uint8_t>& message) {
  FrameHead head;
  std::memcpy(&head, message.data(), kFrameHeadBytes);
  return head;
}

PicturePieces::PicturePieces(const std::vector<uint8_t>* before, SharedBytes now,
                             size_t piece_bytes)
    : picture_(std::move(now)), head_(HeadOf(*picture_)) {
  if (before != nullptr) {
    const FrameHead old = HeadOf(*before);
    if (old.width == head_.width && old.height == head_.height) {
      FindChange(before->data() + kFrameHeadBytes, picture_->data() + kFrameHeadBytes, &head_);
    }
  }
  const size_t row_bytes = size_t{4} * std::max(head_.part_width, 1U);
  rows_ = static_cast<uint32_t>(std::max<size_t>(piece_bytes / row_bytes, 1));
  head_.pieces = std::max((head_.part_height + rows_ - 1) / rows_, 1U);
}

SharedBytes PicturePieces::Piece(uint32_t number) const {
  FrameHead head = head_;
  head.piece = number;
  head.part_y += number * rows_;
  head.part_height = std::min(rows_, head_.part_height - number * rows_);
  const size_t row_bytes = size_t{4} * head.part_width;
  auto message = WithHead(head, row_bytes * head.part_height);
  for (size_t y = 0; y < head.part_height; ++y) {
    const size_t pixel = (head.part_y + y) * head.width + head.part_x;
    std::memcpy(message->data() + kFrameHeadBytes + row_bytes * y,
                picture_->data() + kFrameHeadBytes + 4 * pixel, row_bytes);
  }
  return message;
}

SharedBytes FileBytes(FileKind kind, const std::vector<uint8_t>& file) {
  FrameHead head;
  head.kind = static_cast<uint32_t>(kind);
  const auto message = WithHead(head, file.size());
  std::copy(file.begin(), file.end(), message->begin() + kFrameHeadBytes);
  return message;
}

SharedBytes SampleBytes(FrameHead head, std::span<const Channel* const> channels) {
  const size_t pixels = size_t{head.width} * head.height;
  head.kind = 2;
  const auto message = WithHead(head, channels.size() * pixels * sizeof(float));
  uint8_t* out = message->data() + kFrameHeadBytes;
  for (const Channel* channel : channels) {
    std::memcpy(out, channel->samples.data(), pixels * sizeof(float));
    out += pixels * sizeof(float);
  }
  return message;
}

}  // namespace nacre
