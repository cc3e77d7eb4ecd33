// SPDX-License-Identifier: Apache-2.0
#include "study/picture.h"

#include <algorithm>
#include <cmath>

#include "image_io/draw_text.h"
#include "render/render.h"

namespace nacre {
namespace {

constexpr int kTextPx = 20;
constexpr int kGap = 8;
constexpr uint8_t kGround = 30;

int LongestWidth(const std::vector<std::string>& texts) {
  double width = 0;
  for (const std::string& text : texts) width = std::max(width, TextWidth(text, kTextPx));
  return texts.empty() ? 0 : static_cast<int>(std::ceil(width)) + 2 * kGap;
}

void Blit(const Pane& pane, int left, int top, StudyPicture* picture) {
  for (int y = 0; y < pane.height; ++y) {
    const std::ptrdiff_t to = static_cast<std::ptrdiff_t>(top + y) * picture->width + left;
    std::copy_n(pane.rgb8.begin() + 3 * static_cast<std::ptrdiff_t>(y) * pane.width, 3 * pane.width,
                picture->rgb8.begin() + 3 * to);
  }
}

TextItem Word(const std::string& text, int x, int y, AlignX align) {
  TextItem item;
  item.text = text;
  item.x = x;
  item.y = y;
  item.size_px = kTextPx;
  item.align_x = align;
  item.align_y = AlignY::kCenter;
  return item;
}

}  // namespace

Scene SphereScene(const Material& material, int pixels, double height) {
  Scene scene;
  scene.camera.projection = Projection::kOrthographic;
  scene.camera.position = {0, 0, 10};
  scene.camera.height = height;
  scene.image.width = scene.image.height = pixels;
  scene.materials.push_back(material);
  scene.spheres.push_back({{0, 0, 0}, 1, {0}});
  return scene;
}

Light SunTowards(const Vec3d& to_light, const Rgb& irradiance) {
  Light light;
  light.name = "sun";
  light.kind = DirectionalLight{.direction_of_travel = -to_light, .irradiance = irradiance};
  return light;
}

Image RenderLayers(const Scene& scene, const std::vector<std::string>& layers) {
  RenderSettings settings;
  settings.layers = layers;
  return RenderImage(scene, settings);
}

Pane ShowLayer(const Image& image, const std::string& layer, const DisplaySettings& display) {
  const std::string prefix = layer.empty() ? "" : layer + ".";
  Pane pane{image.data.width(), image.data.height(), {}};
  pane.rgb8.resize(3 * image.data.pixel_count());
  const auto plane = [&](const char* channel) {
    return image.Find(prefix + channel)->samples.data();
  };
  EncodeDisplay(display, plane("R"), plane("G"), plane("B"), image.data.pixel_count(),
                pane.rgb8.data());
  return pane;
}

StudyPicture MakeStudyPicture(const std::string& name, const std::string& caption,
                              const PaneSheet& sheet) {
  const Pane& first = sheet.panes.front();
  const int rows = std::max(static_cast<int>(sheet.rows.size()), 1);
  const int columns = static_cast<int>(sheet.panes.size()) / rows;
  const int top = sheet.columns.empty() ? kGap : kTextPx + 3 * kGap;
  const int left = sheet.rows.empty() ? kGap : LongestWidth(sheet.rows);
  StudyPicture picture{
      name, caption, left + columns * (first.width + kGap), top + rows * (first.height + kGap), {}};
  picture.rgb8.assign(3 * static_cast<size_t>(picture.width) * static_cast<size_t>(picture.height),
                      kGround);
  std::vector<TextItem> words;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      Blit(sheet.panes[static_cast<size_t>(row * columns + column)],
           left + column * (first.width + kGap), top + row * (first.height + kGap), &picture);
    }
    if (sheet.rows.empty()) continue;
    words.push_back(Word(sheet.rows[static_cast<size_t>(row)], left - kGap,
                         top + row * (first.height + kGap) + first.height / 2, AlignX::kRight));
  }
  for (size_t i = 0; i < sheet.columns.size(); ++i) {
    const int column_left = left + static_cast<int>(i) * (first.width + kGap);
    words.push_back(
        Word(sheet.columns[i], column_left + first.width / 2, top / 2, AlignX::kCenter));
  }
  DrawText(picture.rgb8, picture.width, picture.height, words);
  return picture;
}

}  // namespace nacre
