#include "cli/labels.h"

#include <algorithm>
#include <cmath>

#include "image_io/oiio.h"
#include "render/camera.h"

namespace nacre {

void DrawLabels(const Scene& scene, const Window& window, std::span<uint8_t> rgb8) {
  const ImageSettings& image = scene.image;
  const Imath::M44d ndc_from_world = WorldToNdc(scene.camera, image.width, image.height);
  const Vec3d forward = scene.camera.look_at - scene.camera.position;
  // Legible at half size, and small enough for a grid of ten columns.
  const int size_px = std::clamp(image.height / 40, 10, 48);
  const int gap = size_px / 2;
  std::vector<TextItem> items;
  for (const Label& label : scene.labels) {
    // What lies behind the camera has no place in the picture.
    if (scene.camera.projection == Projection::kPerspective &&
        ((label.anchor - scene.camera.position) ^ forward) <= 0) {
      continue;
    }
    Vec3d ndc;
    ndc_from_world.multVecMatrix(label.anchor, ndc);
    constexpr double kFarOutside = 4;  // of [-1, 1]: no text reaches the picture from there
    if (!(std::abs(ndc.x) < kFarOutside && std::abs(ndc.y) < kFarOutside)) continue;
    TextItem item;
    item.text = label.text;
    item.size_px = size_px;
    item.x = static_cast<int>((ndc.x + 1) / 2 * image.width) - window.x0;
    item.y = static_cast<int>((1 - ndc.y) / 2 * image.height) - window.y0;
    switch (label.side) {
      case Label::Side::kLeft:
        item.x -= 2 * gap;
        item.align_x = AlignX::kRight;
        item.align_y = AlignY::kCenter;
        break;
      case Label::Side::kAbove:
        item.y -= gap;
        item.align_x = AlignX::kCenter;
        item.align_y = AlignY::kBottom;
        break;
      case Label::Side::kBelow:
        item.y += gap;
        item.align_x = AlignX::kCenter;
        item.align_y = AlignY::kTop;
        break;
    }
    items.push_back(item);
  }
  DrawText(rgb8, window.width(), window.height(), items);
}

}  // namespace nacre
