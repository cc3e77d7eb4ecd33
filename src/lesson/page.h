// SPDX-License-Identifier: Apache-2.0
// lesson/page.h: shows a picture of the lesson beside nacre's own, and the difference of the two.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "base/image.h"
#include "base/picture.h"
#include "lesson/code_change.h"
#include "scene/scene.h"

namespace nacre {

// A scene rendered by nacre's own renderer: the displayed codes (with Reinhard, the tone operator
// of the lesson, and exact sRGB), and the pixels of spheres.
struct AccuratePicture {
  int spp = 0;
  Rgb8Picture shown;
  std::vector<uint8_t> sphere;  // 1 where a sphere covers part of the pixel
};
// `on_progress` gets the finished fraction, and may throw.
AccuratePicture RenderAccurate(const Scene& scene, const std::function<void(double)>& on_progress);

// A part of the pictures, magnified by `zoom`.
struct SheetView {
  Window window;
  int zoom = 1;
};

struct TextbookSheet {
  std::string title;
  std::vector<SheetView> views;  // stacked, all of equal width
};

// Writes lesson | nacre | heat map as one PNG. Both pictures must have the same size.
void WriteTextbookSheet(const std::string& path, const TextbookSheet& sheet,
                        const CodedPicture& lesson, const AccuratePicture& accurate);

}  // namespace nacre
