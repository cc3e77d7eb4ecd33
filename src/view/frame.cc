// SPDX-License-Identifier: Apache-2.0
#include "view/frame.h"

#include <algorithm>
#include <cstring>
#include <span>

#include "base/parallel.h"

namespace nacre {
namespace {

static_assert(sizeof(FrameHead) == kFrameHeadBytes);

std::shared_ptr<std::vector<uint8_t>> WithHead(const FrameHead& head, size_t bytes) {
  auto message = std::make_shared<std::vector<uint8_t>>(kFrameHeadBytes + bytes);
  std::memcpy(message->data(), &head, kFrameHeadBytes);
  return message;
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
  ParallelFor((pixels + kBlock - 1) / kBlock, 0, [&](size_t block) {
    const size_t first = block * kBlock, count = std::min(kBlock, pixels - first);
    std::array<uint8_t, 3 * kBlock> rgb8;
    EncodeDisplay(display, rgb[0] + first, rgb[1] + first, rgb[2] + first, count, rgb8.data());
    for (size_t i = 0; i < count; ++i) {
      uint8_t* const out = rgba + 4 * (first + i);
      out[0] = rgb8[3 * i];
      out[1] = rgb8[3 * i + 1];
      out[2] = rgb8[3 * i + 2];
      out[3] = 255;
    }
  });
  return message;
}

SharedBytes PartSince(const SharedBytes& before, const SharedBytes& now) {
  if (!before) return now;
  FrameHead old, head;
  std::memcpy(&old, before->data(), kFrameHeadBytes);
  std::memcpy(&head, now->data(), kFrameHeadBytes);
  if (old.width != head.width || old.height != head.height) return now;
  const size_t row_bytes = size_t{4} * head.width;
  const auto row_of = [&](const SharedBytes& bytes, size_t y) {
    return bytes->data() + kFrameHeadBytes + y * row_bytes;
  };
  size_t top = head.height, bottom = 0, left = head.width, right = 0;
  for (size_t y = 0; y < head.height; ++y) {
    const uint8_t *const a = row_of(before, y), *const b = row_of(now, y);
    const auto same = [&](size_t x) { return std::memcmp(a + 4 * x, b + 4 * x, 4) == 0; };
    if (std::memcmp(a, b, row_bytes) == 0) continue;
    top = std::min(top, y);
    bottom = y + 1;
    size_t x = 0, end = head.width;
    while (x < left && same(x)) ++x;
    while (end > right && same(end - 1)) --end;
    left = std::min(left, x);
    right = std::max(right, end);
  }
  const size_t width = right > left ? right - left : 0, height = bottom > top ? bottom - top : 0;
  // What is copied for little is sent as it is, to all pages the same bytes.
  if (8 * width * height > 7 * size_t{head.width} * head.height) return now;
  head.part_x = static_cast<uint32_t>(width > 0 ? left : 0);
  head.part_y = static_cast<uint32_t>(height > 0 ? top : 0);
  head.part_width = static_cast<uint32_t>(width);
  head.part_height = static_cast<uint32_t>(height);
  auto message = WithHead(head, 4 * width * height);
  for (size_t y = 0; y < height; ++y) {
    std::memcpy(message->data() + kFrameHeadBytes + 4 * width * y, row_of(now, top + y) + 4 * left,
                4 * width);
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
