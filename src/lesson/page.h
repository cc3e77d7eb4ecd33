// SPDX-License-Identifier: Apache-2.0
// lesson/page.h: a picture of the lesson beside nacre's own and the difference of the two.
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

// A scene by nacre's own renderer: as shown (Reinhard, which is the lesson's tone operator, and
// exact sRGB) and where spheres are.
struct AccuratePicture {
  int spp = 0;
  Rgb8Picture shown;
  std::vector<uint8_t> sphere;  // 1 where a sphere covers part of the pixel
};
// on_progress is told the share done, and may throw.
AccuratePicture RenderAccurate(const Scene& scene, const std::function<void(double)>& on_progress);

// A part of the pictures, each pixel `zoom` times as large.
struct SheetView {
  Window window;
  int zoom = 1;
};

struct TextbookSheet {
  std::string title;
  std::vector<SheetView> views;  // one below the other, all equally wide
};

// Writes lesson | nacre | heat map as one PNG. Both pictures have the lesson's size.
void WriteTextbookSheet(const std::string& path, const TextbookSheet& sheet,
                        const CodedPicture& lesson, const AccuratePicture& accurate);

}  // namespace nacre
