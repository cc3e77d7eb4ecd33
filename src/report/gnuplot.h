// SPDX-License-Identifier: Apache-2.0
// report/gnuplot.h: converts a figure to commands and data for gnuplot.
#pragma once

#include <string>

#include "report/figure.h"

namespace nacre {

enum class PictureFormat : uint8_t { kSvg, kPng };

// The complete input for gnuplot to draw the figure to its standard output.
std::string GnuplotScript(const Figure& figure, PictureFormat format);

// Quotes a string for gnuplot. In single quotes, only the quote itself is special; it becomes an
// apostrophe, because gnuplot misreads it at the start of a string. Control characters, including
// line breaks, are spelled out (base/printable.h), as they would end the command or break the SVG
// file.
std::string GnuplotQuote(const std::string& text);

}  // namespace nacre
