// SPDX-License-Identifier: Apache-2.0
#include "cli/heat_picture.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "image_io/canvas.h"
#include "image_io/png_writer.h"

namespace nacre {
namespace {

constexpr int kTextPx = 13;
constexpr int kBarHeight = 12;
constexpr int kLegendHeight = 60;
constexpr int kMargin = 24;
constexpr int kMinWidth = 320;  // so that the text of the legend fits

constexpr Rgb8 kGround = {24, 24, 24};

TextItem LegendText(const std::string& text, int x, int y) {
  return {.text = text, .x = x, .y = y, .size_px = kTextPx, .align_x = AlignX::kCenter};
}

void DrawLegend(int top, int width, HeatQuantity quantity, const HeatScale& scale, Canvas* page) {
  page->Paste(HeatLegend(width, kBarHeight), kMargin, top);
  const int low = static_cast<int>(std::ceil(std::log10(scale.low) - 1e-9));
  const int high = static_cast<int>(std::floor(std::log10(scale.high) + 1e-9));
  for (int power = low; power <= high; ++power) {
    const int x = kMargin + static_cast<int>(scale.Position(std::pow(10.0, power)) * width);
    page->AddText(LegendText(fmt::format("1e{}", power), x, top + kBarHeight + 3));
  }
  page->AddText(LegendText(quantity == HeatQuantity::kRelative
                               ? "error / sqrt(reference^2 + 0.01^2), black: equal"
                               : "absolute error, black: equal",
                           width / 2 + kMargin, top + kBarHeight + 5 + kTextPx));
}

}  // namespace

void WriteHeatPicture(const std::string& path, const Rgb8Picture& map, HeatQuantity quantity,
                      const HeatScale& scale) {
  const int width = std::max(map.width, kMinWidth);
  Canvas page(width, map.height + kLegendHeight, kGround);
  page.Paste(map, 0, 0);
  DrawLegend(map.height + 8, width - 2 * kMargin, quantity, scale, &page);
  WritePng(path, page.Draw());
}

}  // namespace nacre
