// SPDX-License-Identifier: Apache-2.0
// cli/sheet_page.h: where things are on a sheet: cells with a sphere each, and around them, on the
// plain ground, title, axis names, values and a footer. All in pixels of the picture.
#pragma once

#include <string>
#include <vector>

#include "image_io/draw_text.h"

namespace nacre {

struct SheetText {
  std::string title;
  std::string row_name;  // above the rows' values
  std::vector<std::string> row_labels;
  std::string column_name;  // above the columns' values
  std::vector<std::string> column_labels;
  std::vector<std::string> footer;  // paragraphs
};

struct SheetRequest {
  int rows = 1, columns = 1;
  int width = 0, height = 0;  // of the picture; 0: what the cells and the text need
  double cell = 0;            // side of a cell in pixels; 0: what fits
  double strip = 0;           // room below the cells for the caller, in sizes of the text
  bool light_ground = false;  // dark text
};

struct SheetPage {
  int width = 0, height = 0;
  double cell = 0;           // side of a cell, a whole number unless the frame is tiny
  double left = 0, top = 0;  // of the first cell
  double text_px = 0;        // size of the text; 0: there is no room for any
  double strip_top = 0;      // of the caller's strip
  std::vector<TextItem> text;
};

// Without room for text (or with none given) the cells fill the frame.
SheetPage LayOutSheet(const SheetText& text, const SheetRequest& request);

// Colours of text on a light or dark ground: of what is read first, and of the rest.
Rgb8 InkColor(bool light_ground);
Rgb8 FaintInkColor(bool light_ground);

}  // namespace nacre
