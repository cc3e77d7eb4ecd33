// SPDX-License-Identifier: Apache-2.0
// view/frame.h: the binary messages to pages: display pictures, samples and files.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/image.h"
#include "color/display.h"

namespace nacre {

using SharedBytes = std::shared_ptr<const std::vector<uint8_t>>;

// The head of a message: 32-bit words, little-endian. html/socket.js reads them in this order.
struct FrameHead {
  uint32_t kind = 1;      // 1: a picture with interleaved R, G, B, A; 2: planes of floats; or a
                          // FileKind: a file
  uint32_t revision = 0;  // revision of the scene that is shown
  uint32_t width = 0, height = 0;              // of this picture
  uint32_t frame_width = 0, frame_height = 0;  // at full size, to which the page scales it
  uint32_t samples = 0, of_samples = 0;        // per pixel
  uint32_t done = 0;                           // 1: the picture is final
  uint32_t render_us = 0;                      // render time
  uint32_t moving = 0;                         // 1: rendered while the scene is being changed
  // For a picture, which comes in pieces: the rectangle of the pixels that follow. Pixels in no
  // piece are unchanged.
  uint32_t part_x = 0, part_y = 0, part_width = 0, part_height = 0;
  uint32_t piece = 0, pieces = 1;
};
inline constexpr size_t kFrameHeadBytes = 68;

// Files for the user to download.
enum class FileKind : uint32_t { kExr = 3, kReport = 4 };

// A message with the display picture of three planes of the image.
SharedBytes PictureBytes(FrameHead head, const std::array<const float*, 3>& rgb,
                         const DisplaySettings& display);

// A picture for a page that shows another one: the bounding rectangle of the differences, in
// pieces.
class PicturePieces {
 public:
  // `before` may be null. Pieces have at most `piece_bytes`, but at least a row of pixels.
  PicturePieces(const std::vector<uint8_t>* before, SharedBytes now, size_t piece_bytes);

  uint32_t count() const { return head_.pieces; }
  SharedBytes Piece(uint32_t number) const;

 private:
  SharedBytes picture_;
  FrameHead head_;  // for the whole rectangle
  uint32_t rows_ = 1;
};

FrameHead HeadOf(const std::vector<uint8_t>& message);

SharedBytes FileBytes(FileKind kind, const std::vector<uint8_t>& file);

// A message with the planes of these channels, one after the other.
SharedBytes SampleBytes(FrameHead head, std::span<const Channel* const> channels);

}  // namespace nacre
