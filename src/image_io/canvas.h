// SPDX-License-Identifier: Apache-2.0
// image_io/canvas.h: a picture of display codes that is composed of other pictures and text.
#pragma once

#include <utility>
#include <vector>

#include "base/image.h"
#include "base/picture.h"
#include "image_io/draw_text.h"

namespace nacre {

class Canvas {
 public:
  Canvas(int width, int height, const Rgb8& ground)
      : picture_(FilledPicture(width, height, ground)) {}

  // Copies the picture to (left, top), clipped to the canvas.
  void Paste(const Rgb8Picture& picture, int left, int top) {
    Paste(picture, {0, 0, picture.width, picture.height}, 1, left, top);
  }
  // Copies the part `part` of the picture, magnified by `zoom`.
  void Paste(const Rgb8Picture& picture, const Window& part, int zoom, int left, int top);

  // Text is not drawn until Draw().
  void AddText(TextItem item) { text_.push_back(std::move(item)); }
  void AddText(const std::vector<TextItem>& items) {
    text_.insert(text_.end(), items.begin(), items.end());
  }

  // Draws the text and returns the complete picture. Throws as DrawText does.
  const Rgb8Picture& Draw();

 private:
  Rgb8Picture picture_;
  std::vector<TextItem> text_;
};

}  // namespace nacre
