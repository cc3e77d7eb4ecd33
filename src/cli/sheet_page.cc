// SPDX-License-Identifier: Apache-2.0
#include "cli/sheet_page.h"

#include <algorithm>
#include <cmath>

#include "cli/wrap_text.h"
#include "image_io/draw_text.h"

namespace nacre {
namespace {

// Sizes in multiples of the text size.
constexpr double kPad = 1.1;  // padding around everything
constexpr double kTitleSize = 1.25;
constexpr double kFooterSize = 0.82;
constexpr double kLine = 1.3;           // line spacing, in multiples of the line's own size
constexpr double kRowLine = 1.15;       // minimum distance of row labels
constexpr double kGap = 0.55;           // between text and what it labels
constexpr double kWidestRowLabel = 20;  // longer labels are cut

struct Margins {
  double left = 0, right = 0, top = 0, bottom = 0;
  FittedLabels columns;
  double row_label_size = 0;
  std::vector<std::string> row_labels;
  std::vector<std::string> title, footer;  // lines
};

double LineHeight(double size) { return kLine * size; }

// The margins that the text needs if its size is `em`, cells are `cell` wide, and the page `width`.
Margins MeasureMargins(const SheetText& text, double em, double cell, double width) {
  Margins m;
  m.left = m.right = m.top = m.bottom = kPad * em;
  const double text_width = width - 2 * kPad * em;
  m.title = WrapText(text.title, kTitleSize * em, text_width);
  for (const std::string& paragraph : text.footer) {
    for (std::string& line : WrapText(paragraph, kFooterSize * em, text_width)) {
      m.footer.push_back(std::move(line));
    }
  }
  if (!m.title.empty()) {
    m.top += static_cast<double>(m.title.size()) * LineHeight(kTitleSize * em) + kGap * em;
  }
  if (!text.column_name.empty()) m.top += LineHeight(em);
  m.row_label_size = std::clamp(cell / kRowLine, 0.7 * em, em);
  double widest = DrawnWidth(text.row_name, em);
  for (const std::string& label : text.row_labels) {
    m.row_labels.push_back(CutText(label, m.row_label_size, kWidestRowLabel * em));
    widest = std::max(widest, DrawnWidth(m.row_labels.back(), m.row_label_size));
  }
  if (widest > 0) m.left += widest + kGap * em;
  // The block of cells is centred between the margins; half of the padding stays free.
  const double columns = static_cast<double>(text.column_labels.size());
  const double spare = std::max(width - m.left - m.right - columns * cell, 0.0) / 2;
  // The name of the rows is on the line of the column labels.
  const double left = text.row_name.empty() ? m.left + spare - kPad * em / 2 : kGap * em / 2;
  m.columns = FitLabels(text.column_labels, em, cell, {left, m.right + spare - kPad * em / 2});
  m.top += m.columns.lines * LineHeight(m.columns.size);
  if (!text.column_labels.empty()) m.top += kGap * em / 2;
  if (!m.footer.empty()) {
    m.bottom += static_cast<double>(m.footer.size()) * LineHeight(kFooterSize * em) + kGap * em;
  }
  return m;
}

void Write(const std::string& text, double x, double y, double size, AlignX align, const Rgb8& ink,
           SheetPage* page, AlignY align_y = AlignY::kTop) {
  page->text.push_back(PlainText(text, x, y, size, align, ink, align_y));
}

void WriteColumns(const SheetText& text, const Margins& m, bool light, SheetPage* page) {
  const double em = page->text_px;
  const double size = m.columns.size;
  const double bottom = page->top - kGap * em / 2;  // bottom of the last line
  const double columns = static_cast<double>(text.column_labels.size());
  if (!text.column_name.empty()) {
    const double y = bottom - m.columns.lines * LineHeight(size) - LineHeight(em);
    Write(text.column_name, page->left + columns * page->cell / 2, y, em, AlignX::kCenter,
          FaintInkColor(light), page);
  }
  for (const FittedLabels::Label& label : m.columns.labels) {
    const double x = page->left + (static_cast<double>(label.place) + 0.5) * page->cell;
    const double height = label.below + static_cast<double>(label.lines.size());
    double y = bottom - height * LineHeight(size);
    for (const std::string& line : label.lines) {
      Write(line, x, y, size, AlignX::kCenter, InkColor(light), page);
      y += LineHeight(size);
    }
  }
}

void WriteRows(const SheetText& text, const Margins& m, bool light, SheetPage* page) {
  const double em = page->text_px;
  const double x = page->left - kGap * em;
  if (!text.row_name.empty()) {
    Write(text.row_name, x, page->top - kGap * em / 2 - LineHeight(em), em, AlignX::kRight,
          FaintInkColor(light), page);
  }
  const size_t count = text.row_labels.size();
  if (count == 0) return;
  // Labels are skipped where lines would touch.
  const double line = kRowLine * m.row_label_size;
  const auto apart = static_cast<size_t>(std::ceil(line / page->cell));  // places
  const size_t written = std::max((count - 1) / apart + 1, size_t{2});
  const std::vector<size_t> places =
      count > 1 ? SpreadPlaces(count - 1, written) : std::vector<size_t>{0};
  for (const size_t i : places) {
    const double y = page->top + (static_cast<double>(i) + 0.5) * page->cell;
    Write(m.row_labels[i], x, y, m.row_label_size, AlignX::kRight, InkColor(light), page,
          AlignY::kCenter);
  }
}

// The largest cell size that leaves room for the margins.
double CellThatFits(const SheetRequest& r, const Margins& m) {
  const double x = (r.width - m.left - m.right) / r.columns;
  const double y = (r.height - m.top - m.bottom) / r.rows;
  const double cell = std::min(x, y);
  return cell > 4 ? std::floor(cell) : cell;
}

bool HasText(const SheetText& text) {
  return !text.title.empty() || !text.row_labels.empty() || !text.column_labels.empty() ||
         !text.footer.empty();
}

// Chooses the sizes of the page that the request leaves open.
Margins ChooseSizes(const SheetText& text, const SheetRequest& r, SheetPage* page) {
  constexpr double kSmallestText = 6;
  const auto measure = [&](double em, double cell, double width) {
    Margins m = MeasureMargins(text, em, cell, width);
    m.bottom += r.strip * em;
    return m;
  };
  if (r.width == 0) {  // the cells determine the page's width
    const double extent = (r.columns + r.rows) * page->cell / 2;
    page->text_px = std::round(std::clamp(extent / 36, 18.0, 48.0));
    const double narrowest = 26 * page->text_px;
    Margins m = measure(page->text_px, page->cell, narrowest);
    const double width = std::max(m.left + r.columns * page->cell + m.right, narrowest);
    m = measure(page->text_px, page->cell, width);
    page->width = static_cast<int>(std::ceil(width));
    page->height = static_cast<int>(std::ceil(m.top + r.rows * page->cell + m.bottom));
    return m;
  }
  page->width = r.width;
  page->height = r.height;
  for (double em = std::min(std::min(r.width, r.height) / 32.0, 64.0); em >= kSmallestText;
       em *= 0.9) {
    Margins m = measure(em, std::min(r.width * 0.8 / r.columns, r.height * 0.8 / r.rows), r.width);
    m = measure(em, std::max(CellThatFits(r, m), 1.0), r.width);  // now that the size is known
    const double cell = CellThatFits(r, m);
    const bool has_room = cell * r.columns > 0.5 * r.width || cell * r.rows > 0.5 * r.height;
    if (!has_room) continue;
    page->text_px = em;
    page->cell = cell;
    return m;
  }
  Margins none;
  page->cell = CellThatFits(r, none);
  return none;
}

double DefaultCell(const SheetRequest& r) {
  return std::floor(std::clamp(std::min(1200.0 / r.columns, 900.0 / r.rows), 24.0, 420.0));
}

}  // namespace

Rgb8 InkColor(bool light_ground) {
  if (light_ground) return {20, 20, 24};
  return {240, 240, 240};
}

Rgb8 FaintInkColor(bool light_ground) {
  if (light_ground) return {80, 80, 88};
  return {176, 178, 184};
}

SheetPage LayOutSheet(const SheetText& text, const SheetRequest& request) {
  SheetPage page;
  page.cell = request.cell > 0 ? request.cell : DefaultCell(request);
  Margins m;
  if (HasText(text) || request.strip > 0) {
    m = ChooseSizes(text, request, &page);
  } else if (request.width > 0) {
    page.width = request.width;
    page.height = request.height;
    page.cell = CellThatFits(request, m);
  } else {
    page.width = static_cast<int>(std::ceil(request.columns * page.cell));
    page.height = static_cast<int>(std::ceil(request.rows * page.cell));
  }
  // Distributes the remaining space to both sides.
  const double spare_x = page.width - m.left - m.right - request.columns * page.cell;
  const double spare_y = page.height - m.top - m.bottom - request.rows * page.cell;
  page.left = std::floor(m.left + spare_x / 2);
  page.top = std::floor(m.top + spare_y / 2);
  page.strip_top = page.top + request.rows * page.cell + kGap * page.text_px;
  if (page.text_px == 0) return page;

  const bool light = request.light_ground;
  const double em = page.text_px;
  double y = kPad * em;
  for (const std::string& line : m.title) {
    Write(line, kPad * em, y, kTitleSize * em, AlignX::kLeft, InkColor(light), &page);
    y += LineHeight(kTitleSize * em);
  }
  WriteColumns(text, m, light, &page);
  WriteRows(text, m, light, &page);
  y = page.height - kPad * em - static_cast<double>(m.footer.size()) * LineHeight(kFooterSize * em);
  for (const std::string& line : m.footer) {
    Write(line, kPad * em, y, kFooterSize * em, AlignX::kLeft, FaintInkColor(light), &page);
    y += LineHeight(kFooterSize * em);
  }
  return page;
}

}  // namespace nacre
