// cli/textbook_sheet.h: a picture of the lesson beside nacre's own and the difference of the two.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cli/textbook_measure.h"
#include "scene/scene.h"

namespace nacre {

// A scene by nacre's own renderer: its codes (Reinhard, which is the lesson's tone operator, and
// exact sRGB) and where spheres are.
struct AccuratePicture {
  int spp = 0;
  std::vector<uint8_t> codes;
  std::vector<uint8_t> sphere;  // 1 where a sphere covers part of the pixel
};
AccuratePicture RenderAccurate(const Scene& scene);

// Writes lesson | nacre | heat map as one PNG. Both pictures have the lesson's size.
void WriteTextbookSheet(const std::string& path, const std::string& title,
                        const CodedPicture& lesson, const AccuratePicture& accurate);

}  // namespace nacre
