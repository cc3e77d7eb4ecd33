// SPDX-License-Identifier: Apache-2.0
#include "cli/labels.h"

#include <algorithm>
#include <cmath>

#include "image_io/draw_text.h"
#include "render/camera.h"

namespace nacre {

namespace {

// The text size: legible at half resolution if there is room for that, but so small that labels of
// neighbouring columns do not touch.
int LabelSize(const Scene& scene, const Imath::M44d& ndc_from_world) {
  constexpr double kGlyphWidth = 0.52;  // mean width over letters and digits of DejaVu Sans, per
                                        // size
  double size = std::clamp(scene.image.height / 40.0, 10.0, 48.0);
  const Label* left = nullptr;
  for (const Label& label : scene.labels) {
    if (label.side == Label::Side::kLeft) continue;
    if (left != nullptr && left->side == label.side) {
      Vec3d a, b;
      ndc_from_world.multVecMatrix(left->anchor, a);
      ndc_from_world.multVecMatrix(label.anchor, b);
      const double spacing = std::abs(b.x - a.x) / 2 * scene.image.width;
      const double glyphs = static_cast<double>(left->text.size() + label.text.size()) / 2 + 1;
      size = std::min(size, spacing / (glyphs * kGlyphWidth));
    }
    left = &label;
  }
  constexpr double kSmallest = 5;
  return static_cast<int>(std::max(size, kSmallest));
}

// Whether two lines of the same size would touch.
bool Touch(const TextItem& a, const TextItem& b) {
  const auto begin = [](const TextItem& item, double width) {
    return item.x - (item.align_x == AlignX::kRight ? width : width / 2);
  };
  const double a_width = DrawnWidth(a.text, a.size_px), b_width = DrawnWidth(b.text, b.size_px);
  const double a_begin = begin(a, a_width), b_begin = begin(b, b_width);
  const double gap = a.size_px / 2.0;
  return std::abs(a.y - b.y) < a.size_px && a_begin < b_begin + b_width + gap &&
         b_begin < a_begin + a_width + gap;
}

}  // namespace

void DrawLabels(const Scene& scene, const Window& window, std::span<uint8_t> rgb8) {
  const ImageSettings& image = scene.image;
  const Imath::M44d ndc_from_world = WorldToNdc(scene.camera, image.width, image.height);
  const Vec3d forward = scene.camera.look_at - scene.camera.position;
  const int size_px = LabelSize(scene, ndc_from_world);
  const int gap = size_px / 2;
  std::vector<TextItem> items;
  for (const Label& label : scene.labels) {
    // Anchors behind the camera are not in the picture.
    if (scene.camera.projection == Projection::kPerspective &&
        ((label.anchor - scene.camera.position) ^ forward) <= 0) {
      continue;
    }
    Vec3d ndc;
    ndc_from_world.multVecMatrix(label.anchor, ndc);
    constexpr double kFarOutside = 4;  // compared to [-1, 1]: no text reaches the picture from
                                       // there
    if (!(std::abs(ndc.x) < kFarOutside && std::abs(ndc.y) < kFarOutside)) continue;
    TextItem item;
    item.text = label.text;
    item.size_px = size_px;
    item.x = static_cast<int>((ndc.x + 1) / 2 * image.width) - window.x0;
    item.y = static_cast<int>((1 - ndc.y) / 2 * image.height) - window.y0;
    if (label.side == Label::Side::kLeft) {
      item.x -= 2 * gap;
      item.align_x = AlignX::kRight;
      item.align_y = AlignY::kCenter;
    } else {
      const bool above = label.side == Label::Side::kAbove;
      item.y += above ? -gap : gap;
      item.align_x = AlignX::kCenter;
      item.align_y = above ? AlignY::kBottom : AlignY::kTop;
    }
    const auto touches = [&](const TextItem& other) { return Touch(item, other); };
    if (std::any_of(items.begin(), items.end(), touches)) continue;
    items.push_back(item);
  }
  DrawText(rgb8, window.width(), window.height(), items);
}

}  // namespace nacre
