// SPDX-License-Identifier: Apache-2.0
// view/frame.h: what pages are sent as bytes: pictures for the display, and samples.
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

// The head of a message: 32-bit words, lowest byte first. html/socket.js reads them in this order.
struct FrameHead {
  uint32_t kind = 1;      // 1: a picture, R, G, B, A of a pixel side by side; 2: planes of floats;
                          // a FileKind: a file
  uint32_t revision = 0;  // of the scene that it shows
  uint32_t width = 0, height = 0;              // of the picture
  uint32_t frame_width = 0, frame_height = 0;  // of the whole picture; larger while things move
  uint32_t samples = 0, of_samples = 0;        // of each pixel
  uint32_t done = 0;                           // 1: nothing is refined any more
  uint32_t render_us = 0;                      // what it took to render
  uint32_t moving = 0;                         // 1: made while things move
  // Of a picture, which comes in pieces: the pixels that follow. Those in no piece are as they
  // were.
  uint32_t part_x = 0, part_y = 0, part_width = 0, part_height = 0;
  uint32_t piece = 0, pieces = 1;
};
inline constexpr size_t kFrameHeadBytes = 68;

// Files that are taken away.
enum class FileKind : uint32_t { kExr = 3, kReport = 4 };

// The picture that a display shows of three planes of the image.
SharedBytes PictureBytes(FrameHead head, const std::array<const float*, 3>& rgb,
                         const DisplaySettings& display);

// A picture for who has another one: the rectangle of it that is not the same, in pieces.
class PicturePieces {
 public:
  // `before` may be null. Pieces have `piece_bytes` or less, but at least a row of pixels.
  PicturePieces(const std::vector<uint8_t>* before, SharedBytes now, size_t piece_bytes);

  uint32_t count() const { return head_.pieces; }
  SharedBytes Piece(uint32_t number) const;

 private:
  SharedBytes picture_;
  FrameHead head_;  // of all of the rectangle
  uint32_t rows_ = 1;
};

FrameHead HeadOf(const std::vector<uint8_t>& message);

SharedBytes FileBytes(FileKind kind, const std::vector<uint8_t>& file);

// The planes of these channels, one after the other.
SharedBytes SampleBytes(FrameHead head, std::span<const Channel* const> channels);

}  // namespace nacre
