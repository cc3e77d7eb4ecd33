// SPDX-License-Identifier: Apache-2.0
#include "cli/canvas.h"

#include <algorithm>
#include <cmath>

#include "base/version.h"
#include "image_io/png_writer.h"

namespace nacre {

Canvas::Canvas(int width, int height, const std::array<uint8_t, 3>& ground)
    : width_(width), height_(height) {
  rgb8_.resize(3 * static_cast<size_t>(width) * static_cast<size_t>(height));
  for (size_t i = 0; i < rgb8_.size(); i += 3) {
    std::copy(ground.begin(), ground.end(), rgb8_.begin() + static_cast<std::ptrdiff_t>(i));
  }
}

void Canvas::Paste(const std::vector<uint8_t>& rgb8, int width, int left, int top) {
  const int height = static_cast<int>(rgb8.size() / 3 / static_cast<size_t>(width));
  const int x0 = std::max(-left, 0);
  const int x1 = std::min(width, width_ - left);
  if (x1 <= x0) return;
  for (int y = std::max(-top, 0); y < std::min(height, height_ - top); ++y) {
    const std::ptrdiff_t from = static_cast<std::ptrdiff_t>(y) * width + x0;
    const std::ptrdiff_t to = static_cast<std::ptrdiff_t>(top + y) * width_ + left + x0;
    std::copy_n(rgb8.begin() + 3 * from, 3 * static_cast<std::ptrdiff_t>(x1 - x0),
                rgb8_.begin() + 3 * to);
  }
}

void Canvas::Write(const std::string& text, double x, double y, double size_px, AlignX align,
                   const std::array<uint8_t, 3>& ink) {
  TextItem item;
  item.text = text;
  item.x = static_cast<int>(std::lround(x));
  item.y = static_cast<int>(std::lround(y));
  item.size_px = std::max(static_cast<int>(std::lround(size_px)), 1);
  item.align_x = align;
  item.color = ink;
  item.outline = false;
  text_.push_back(std::move(item));
}

void Canvas::AddText(const std::vector<TextItem>& items) {
  text_.insert(text_.end(), items.begin(), items.end());
}

void Canvas::DrawText() {
  if (!text_.empty()) nacre::DrawText(rgb8_, width_, height_, text_);
  text_.clear();
}

void Canvas::WritePng(const std::string& path, bool small) const {
  PngHeader header;
  header.width = width_;
  header.height = height_;
  header.text = {{"Software", std::string("nacre ") + kVersion}};
  PngWriter png(path, header, PngOptions{.small = small});
  for (int y = 0; y < height_; y += PngWriter::kStripRows) {
    png.WriteStrip(y, std::min(PngWriter::kStripRows, height_ - y),
                   rgb8_.data() + 3 * static_cast<size_t>(y) * static_cast<size_t>(width_));
  }
  png.Finish();
}

}  // namespace nacre
