// SPDX-License-Identifier: Apache-2.0
// cli/sheet_page.h: the layout of a sheet: cells with a sphere each, and, on the plain ground
// around them, a title, axis names, values and a footer. All positions are in pixels of the
// picture.
#pragma once

#include <string>
#include <vector>

#include "image_io/draw_text.h"

namespace nacre {

struct SheetText {
  std::string title;
  std::string row_name;  // written above the row values
  std::vector<std::string> row_labels;
  std::string column_name;  // written above the column values
  std::vector<std::string> column_labels;
  std::vector<std::string> footer;  // paragraphs
};

struct SheetRequest {
  int rows = 1, columns = 1;
  int width = 0, height = 0;  // of the picture; 0: as large as cells and text need
  double cell = 0;            // side of a cell in pixels; 0: as large as fits
  double strip = 0;           // height of a free strip below the cells, in multiples of the text
                              // size
  bool light_ground = false;  // text is dark
};

struct SheetPage {
  int width = 0, height = 0;
  double cell = 0;           // side of a cell, a whole number unless the frame is tiny
  double left = 0, top = 0;  // corner of the first cell
  double text_px = 0;        // text size; 0: no room for text
  double strip_top = 0;      // top of the free strip
  std::vector<TextItem> text;
};

// If there is no room for text, or no text, the cells fill the frame.
SheetPage LayOutSheet(const SheetText& text, const SheetRequest& request);

// Colours for main text and for secondary text, on a light or dark ground.
Rgb8 InkColor(bool light_ground);
Rgb8 FaintInkColor(bool light_ground);

}  // namespace nacre
