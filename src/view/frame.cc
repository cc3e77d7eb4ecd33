// SPDX-License-Identifier: Apache-2.0
#include "view/frame.h"

#include <algorithm>
#include <cstring>

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
