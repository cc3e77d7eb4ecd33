// SPDX-License-Identifier: Apache-2.0
#include "lesson/page.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include <fmt/format.h>

#include "color/display.h"
#include "compare/heat_map.h"
#include "image_io/canvas.h"
#include "image_io/png_writer.h"
#include "render/render.h"

namespace nacre {
namespace {

constexpr int kMargin = 20;
constexpr int kTitlePx = 20;
constexpr int kTextPx = 14;
constexpr int kTop = 72;     // above the panels: title and the panels' names
constexpr int kBottom = 76;  // below: captions and the legend
constexpr int kBarHeight = 12;
constexpr HeatScale kCodeScale{1, 255};

constexpr Rgb8 kGround = {30, 30, 30};

void Write(const std::string& text, int x, int y, int size_px, Canvas* page,
           AlignX align = AlignX::kLeft) {
  page->AddText({.text = text, .x = x, .y = y, .size_px = size_px, .align_x = align});
}

Rgb8Picture HeatOfCodes(const Rgb8Picture& a, const Rgb8Picture& b) {
  Rgb8Picture heat = a;
  for (size_t i = 0; i < heat.rgb8.size(); i += 3) {
    int largest = 0;
    for (size_t c = i; c < i + 3; ++c) largest = std::max(largest, std::abs(a.rgb8[c] - b.rgb8[c]));
    const Rgb8 color = largest == 0 ? kHeatEqual : HeatColor(kCodeScale.Position(largest));
    std::copy(color.begin(), color.end(), heat.rgb8.begin() + static_cast<std::ptrdiff_t>(i));
  }
  return heat;
}

void AddLegend(int left, int top, int width, Canvas* page) {
  page->Paste(HeatLegend(width, kBarHeight), left, top);
  for (const int codes : {1, 3, 10, 30, 100, 255}) {
    const int x = left + static_cast<int>(kCodeScale.Position(codes) * width);
    const AlignX align = codes == 1     ? AlignX::kLeft
                         : codes == 255 ? AlignX::kRight
                                        : AlignX::kCenter;
    Write(fmt::format("{}", codes), x, top + kBarHeight + 5, kTextPx, page, align);
  }
}

}  // namespace

AccuratePicture RenderAccurate(const Scene& scene, const std::function<void(double)>& on_progress) {
  RenderSettings settings;
  settings.on_progress = on_progress;
  const Image image = RenderImage(scene, settings);
  AccuratePicture picture;
  picture.spp = scene.image.spp;
  picture.shown = ShowImage(image, {.tone = ToneOperator::kReinhard});
  picture.sphere.reserve(image.data.pixel_count());
  for (const float alpha : image.Find("A")->samples) picture.sphere.push_back(alpha > 0 ? 1 : 0);
  return picture;
}

void WriteTextbookSheet(const std::string& path, const TextbookSheet& sheet,
                        const CodedPicture& lesson, const AccuratePicture& accurate) {
  const SheetView& first = sheet.views.front();
  const int width = first.window.width() * first.zoom;
  int height = 0;
  for (const SheetView& view : sheet.views) height += view.window.height() * view.zoom;
  const int gaps = static_cast<int>(sheet.views.size()) - 1;
  Canvas page(3 * width + 4 * kMargin, kTop + height + gaps * kMargin + kBottom, kGround);
  const std::array<int, 3> left = {kMargin, 2 * kMargin + width, 3 * kMargin + 2 * width};
  const Rgb8Picture shown = {lesson.picture.width, lesson.picture.height, lesson.codes};
  const Rgb8Picture heat = HeatOfCodes(shown, accurate.shown);
  int top = kTop;
  for (const SheetView& view : sheet.views) {
    page.Paste(shown, view.window, view.zoom, left[0], top);
    page.Paste(accurate.shown, view.window, view.zoom, left[1], top);
    page.Paste(heat, view.window, view.zoom, left[2], top);
    top += view.window.height() * view.zoom + kMargin;
  }
  Write(sheet.title, kMargin, 14, kTitlePx, &page);
  Write("the lesson", left[0], kTop - 22, kTextPx, &page);
  Write("nacre", left[1], kTop - 22, kTextPx, &page);
  Write("difference in 8-bit codes (black: none)", left[2], kTop - 22, kTextPx, &page);
  const int below = top - kMargin + 10;
  Write("its program, faults and all", left[0], below, kTextPx, &page);
  Write(fmt::format("{} samples a pixel, Reinhard, sRGB", accurate.spp), left[1], below, kTextPx,
        &page);
  AddLegend(left[2], below, width, &page);
  const CodeChange change =
      MeasureChange(lesson.codes, accurate.shown.rgb8, lesson.picture.sphere, accurate.sphere);
  Write(fmt::format("on the spheres: largest {}, mean {:.1f}", change.largest, change.mean),
        left[2], below + kBarHeight + 28, kTextPx, &page);
  WritePng(path, page.Draw());
}

}  // namespace nacre
