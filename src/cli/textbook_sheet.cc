// SPDX-License-Identifier: Apache-2.0
#include "cli/textbook_sheet.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include <fmt/format.h>

#include "cli/progress.h"
#include "color/display.h"
#include "compare/heat_map.h"
#include "image_io/draw_text.h"
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

struct Page {
  int width, height;
  std::vector<uint8_t> rgb8;
  std::vector<TextItem> text;
};

// `rows` of three panels each, `height` pixels high in all.
Page MakePage(int panel_width, int height, int rows) {
  constexpr uint8_t kGround = 30;
  Page page{3 * panel_width + 4 * kMargin, kTop + height + (rows - 1) * kMargin + kBottom, {}, {}};
  page.rgb8.assign(3 * static_cast<size_t>(page.width) * static_cast<size_t>(page.height), kGround);
  return page;
}

// Copies `window` of a picture of `width` pixels to (left, top), each pixel `zoom` times as large.
void Blit(const std::vector<uint8_t>& rgb8, int width, const SheetView& view, int left, int top,
          Page* page) {
  const Window& window = view.window;
  for (int y = 0; y < window.height() * view.zoom; ++y) {
    for (int x = 0; x < window.width() * view.zoom; ++x) {
      const std::ptrdiff_t from = static_cast<std::ptrdiff_t>(window.y0 + y / view.zoom) * width +
                                  window.x0 + x / view.zoom;
      const std::ptrdiff_t to = static_cast<std::ptrdiff_t>(top + y) * page->width + left + x;
      std::copy_n(rgb8.begin() + 3 * from, 3, page->rgb8.begin() + 3 * to);
    }
  }
}

void Write(const std::string& text, int x, int y, int size_px, Page* page,
           AlignX align = AlignX::kLeft) {
  TextItem item;
  item.text = text;
  item.x = x;
  item.y = y;
  item.size_px = size_px;
  item.align_x = align;
  page->text.push_back(item);
}

std::vector<uint8_t> HeatOfCodes(const std::vector<uint8_t>& a, const std::vector<uint8_t>& b) {
  std::vector<uint8_t> heat;
  heat.reserve(a.size());
  for (size_t i = 0; i < a.size(); i += 3) {
    int largest = 0;
    for (size_t c = i; c < i + 3; ++c) largest = std::max(largest, std::abs(a[c] - b[c]));
    const Rgb8 color = largest == 0 ? kHeatEqual : HeatColor(kCodeScale.Position(largest));
    heat.insert(heat.end(), color.begin(), color.end());
  }
  return heat;
}

void AddLegend(int left, int top, int width, Page* page) {
  const HeatPicture bar = HeatLegend(width, kBarHeight);
  Blit(bar.rgb8, width, {Window{0, 0, width, kBarHeight}, 1}, left, top, page);
  for (const int codes : {1, 3, 10, 30, 100, 255}) {
    const int x = left + static_cast<int>(kCodeScale.Position(codes) * width);
    const AlignX align = codes == 1     ? AlignX::kLeft
                         : codes == 255 ? AlignX::kRight
                                        : AlignX::kCenter;
    Write(fmt::format("{}", codes), x, top + kBarHeight + 5, kTextPx, page, align);
  }
}

void WritePage(const std::string& path, Page page) {
  DrawText(page.rgb8, page.width, page.height, page.text);
  PngHeader header;
  header.width = page.width;
  header.height = page.height;
  PngWriter png(path, header);
  for (int y = 0; y < page.height; y += PngWriter::kStripRows) {
    png.WriteStrip(y, std::min(PngWriter::kStripRows, page.height - y),
                   page.rgb8.data() + 3 * static_cast<size_t>(y) * static_cast<size_t>(page.width));
  }
  png.Finish();
}

}  // namespace

AccuratePicture RenderAccurate(const Scene& scene) {
  RenderSettings settings;
  settings.on_progress = [](double) { ThrowIfStopped(); };
  const Image image = RenderImage(scene, settings);
  const size_t count = image.data.pixel_count();
  AccuratePicture picture;
  picture.spp = scene.image.spp;
  picture.codes.resize(3 * count);
  DisplaySettings display;
  display.tone = ToneOperator::kReinhard;
  EncodeDisplay(display, image.Find("R")->samples.data(), image.Find("G")->samples.data(),
                image.Find("B")->samples.data(), count, picture.codes.data());
  picture.sphere.reserve(count);
  for (const float alpha : image.Find("A")->samples) picture.sphere.push_back(alpha > 0 ? 1 : 0);
  return picture;
}

void WriteTextbookSheet(const std::string& path, const TextbookSheet& sheet,
                        const CodedPicture& lesson, const AccuratePicture& accurate) {
  const SheetView& first = sheet.views.front();
  const int width = first.window.width() * first.zoom;
  int height = 0;
  for (const SheetView& view : sheet.views) height += view.window.height() * view.zoom;
  Page page = MakePage(width, height, static_cast<int>(sheet.views.size()));
  const std::array<int, 3> left = {kMargin, 2 * kMargin + width, 3 * kMargin + 2 * width};
  const std::vector<uint8_t> heat = HeatOfCodes(lesson.codes, accurate.codes);
  int top = kTop;
  for (const SheetView& view : sheet.views) {
    Blit(lesson.codes, lesson.picture.width, view, left[0], top, &page);
    Blit(accurate.codes, lesson.picture.width, view, left[1], top, &page);
    Blit(heat, lesson.picture.width, view, left[2], top, &page);
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
      MeasureChange(lesson.codes, accurate.codes, lesson.picture.sphere, accurate.sphere);
  Write(fmt::format("on the spheres: largest {}, mean {:.1f}", change.largest, change.mean),
        left[2], below + kBarHeight + 28, kTextPx, &page);
  WritePage(path, std::move(page));
}

}  // namespace nacre
