// SPDX-License-Identifier: Apache-2.0
#include "cli/heat_picture.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "image_io/draw_text.h"
#include "image_io/png_writer.h"

namespace nacre {
namespace {

constexpr int kTextPx = 13;
constexpr int kBarHeight = 12;
constexpr int kLegendHeight = 60;
constexpr int kMargin = 24;
constexpr int kMinWidth = 320;  // of the legend, so that its text fits

// The picture on a dark ground, with room for the legend below.
HeatPicture Extend(const HeatPicture& map) {
  constexpr uint8_t kGround = 24;
  HeatPicture page{std::max(map.width, kMinWidth), map.height + kLegendHeight, {}};
  page.rgb8.assign(3 * static_cast<size_t>(page.width) * static_cast<size_t>(page.height), kGround);
  for (int y = 0; y < map.height; ++y) {
    std::copy_n(map.rgb8.begin() + 3 * static_cast<std::ptrdiff_t>(y) * map.width, 3 * map.width,
                page.rgb8.begin() + 3 * static_cast<std::ptrdiff_t>(y) * page.width);
  }
  return page;
}

void DrawLegend(int top, HeatQuantity quantity, const HeatScale& scale, HeatPicture* page) {
  const int width = page->width - 2 * kMargin;
  const HeatPicture bar = HeatLegend(width, kBarHeight);
  for (int y = 0; y < kBarHeight; ++y) {
    std::copy_n(
        bar.rgb8.begin() + 3 * static_cast<std::ptrdiff_t>(y) * width, 3 * width,
        page->rgb8.begin() + 3 * (static_cast<std::ptrdiff_t>(top + y) * page->width + kMargin));
  }
  std::vector<TextItem> items;
  const int low = static_cast<int>(std::ceil(std::log10(scale.low) - 1e-9));
  const int high = static_cast<int>(std::floor(std::log10(scale.high) + 1e-9));
  for (int power = low; power <= high; ++power) {
    TextItem item;
    item.text = fmt::format("1e{}", power);
    item.x = kMargin + static_cast<int>(scale.Position(std::pow(10.0, power)) * width);
    item.y = top + kBarHeight + 3;
    item.size_px = kTextPx;
    item.align_x = AlignX::kCenter;
    items.push_back(item);
  }
  TextItem title;
  title.text = quantity == HeatQuantity::kRelative
                   ? "error / sqrt(reference^2 + 0.01^2), black: equal"
                   : "absolute error, black: equal";
  title.x = page->width / 2;
  title.y = top + kBarHeight + 5 + kTextPx;
  title.size_px = kTextPx;
  title.align_x = AlignX::kCenter;
  items.push_back(title);
  DrawText(page->rgb8, page->width, page->height, items);
}

}  // namespace

void WriteHeatPicture(const std::string& path, const HeatPicture& map, HeatQuantity quantity,
                      const HeatScale& scale) {
  HeatPicture page = Extend(map);
  DrawLegend(map.height + 8, quantity, scale, &page);
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

}  // namespace nacre
