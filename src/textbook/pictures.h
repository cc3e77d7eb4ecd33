// SPDX-License-Identifier: Apache-2.0
// textbook/pictures.h: the lesson's two pictures.
#pragma once

#include <cstdint>
#include <vector>

#include "textbook/faults.h"
#include "textbook/shading.h"

namespace nacre {

struct TextbookPicture {
  int width = 0, height = 0;
  // The contents of a float file: the lesson's float image, which is display-referred, or linear
  // radiance if encode_per_light is off.
  std::vector<Rgb> film;
  std::vector<Rgb> display;     // in [0, 1], from which 8-bit codes are made
  std::vector<uint8_t> sphere;  // 1 on a sphere, 0 on the background

  size_t pixel_count() const { return film.size(); }
};

// A sphere, its left half Phong, its right half metallic-roughness.
struct TextbookComparison {
  int width = 400, height = 200;
  Vec3d light_position{2, 3, 0};
  int light_count = 1;  // they share the light's colour; one in the lesson
  TextbookPhong phong{.ka = 0.1, .kd = 0.7, .ks = 0.5, .shininess = 64, .color = {0.8, 0.2, 0.2}};
  TextbookPbr pbr{.albedo = {0.8, 0.2, 0.2}, .metallic = 0, .roughness = 0.4};
  TextbookFaults faults{};
};

// render_sphere_comparison().
TextbookPicture RenderTextbookComparison(const TextbookComparison& settings);

// 5 x 5 spheres, with roughness 0.1 to 0.9 from top to bottom, metallic 0 to 1 from left to right.
struct TextbookGrid {
  int width = 600, height = 400;
  int light_count = 1;
  TextbookFaults faults{};
};

// render_material_grid().
TextbookPicture RenderTextbookGrid(const TextbookGrid& settings);

// The 8-bit codes: by default, as in the lesson, (x * 255) truncated.
std::vector<uint8_t> TextbookCodes(const TextbookPicture& picture, const TextbookFaults& faults);

// ---- Facts that follow from the pictures' geometry ----------------------------------------------

// Highlights of the comparison's sphere on the side that faces away from the light (E12): the
// fraction of the sphere's pixels where n.l <= 0 and the lobe is visible in 8 bits, and its largest
// value there.
struct TextbookLeak {
  double share = 0, largest = 0;
};
TextbookLeak MeasureLeak(const Vec3d& light_position, double shininess, bool blinn);

// The fraction of the grid's disc pixels with n.v <= 0, which are seen from behind (E14).
double GridShareSeenFromBehind(const TextbookGrid& settings);

}  // namespace nacre
