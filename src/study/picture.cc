// SPDX-License-Identifier: Apache-2.0
#include "study/picture.h"

#include <algorithm>
#include <cmath>

#include "image_io/canvas.h"
#include "render/render.h"

namespace nacre {
namespace {

constexpr int kTextPx = 20;
constexpr int kGap = 8;
constexpr Rgb8 kGround = {30, 30, 30};

int LongestWidth(const std::vector<std::string>& texts) {
  double width = 0;
  for (const std::string& text : texts) width = std::max(width, DrawnWidth(text, kTextPx));
  return texts.empty() ? 0 : static_cast<int>(std::ceil(width)) + 2 * kGap;
}

TextItem Word(const std::string& text, int x, int y, AlignX align) {
  return {.text = text,
          .x = x,
          .y = y,
          .size_px = kTextPx,
          .align_x = align,
          .align_y = AlignY::kCenter};
}

}  // namespace

Material MaterialOf(const MaterialKind& model) {
  Material material;
  material.model = model;
  return material;
}

Scene SphereScene(const MaterialKind& model, int pixels, const std::vector<Light>& lights) {
  Scene scene;
  scene.camera.projection = Projection::kOrthographic;
  scene.camera.position = {0, 0, 10};
  scene.camera.height = 2.2;
  scene.image.width = scene.image.height = pixels;
  scene.materials.push_back(MaterialOf(model));
  scene.lights = lights;
  scene.spheres.push_back({{0, 0, 0}, 1, {0}});
  return scene;
}

Light SunTowards(const Vec3d& to_light, const Rgb& irradiance) {
  return {.name = "sun",
          .kind = DirectionalLight{.direction_of_travel = -to_light, .irradiance = irradiance}};
}

Image RenderLayers(const Scene& scene, const std::vector<std::string>& layers) {
  RenderSettings settings;
  settings.layers = layers;
  return RenderImage(scene, settings);
}

StudyPicture MakeStudyPicture(const std::string& name, const std::string& caption,
                              const PaneSheet& sheet) {
  const Rgb8Picture& first = sheet.panes.front();
  const int rows = std::max(static_cast<int>(sheet.rows.size()), 1);
  const int columns = static_cast<int>(sheet.panes.size()) / rows;
  const int top = sheet.columns.empty() ? kGap : kTextPx + 3 * kGap;
  const int left = sheet.rows.empty() ? kGap : LongestWidth(sheet.rows);
  Canvas canvas(left + columns * (first.width + kGap), top + rows * (first.height + kGap), kGround);
  for (int row = 0; row < rows; ++row) {
    const int row_top = top + row * (first.height + kGap);
    for (int column = 0; column < columns; ++column) {
      canvas.Paste(sheet.panes[static_cast<size_t>(row * columns + column)],
                   left + column * (first.width + kGap), row_top);
    }
    if (sheet.rows.empty()) continue;
    canvas.AddText(Word(sheet.rows[static_cast<size_t>(row)], left - kGap,
                        row_top + first.height / 2, AlignX::kRight));
  }
  for (size_t i = 0; i < sheet.columns.size(); ++i) {
    const int column_left = left + static_cast<int>(i) * (first.width + kGap);
    canvas.AddText(Word(sheet.columns[i], column_left + first.width / 2, top / 2, AlignX::kCenter));
  }
  return {name, caption, canvas.Draw()};
}

}  // namespace nacre
