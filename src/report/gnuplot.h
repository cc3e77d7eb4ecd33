// SPDX-License-Identifier: Apache-2.0
// report/gnuplot.h: a figure as commands and data for gnuplot.
#pragma once

#include <string>

#include "report/plot.h"

namespace nacre {

enum class PictureFormat : uint8_t { kSvg, kPng };

// All that gnuplot needs to draw the figure to its standard output.
std::string GnuplotScript(const Figure& figure, PictureFormat format);

// A string for gnuplot: in single quotes nothing but the quote itself is special, and that, which
// gnuplot misreads at the start of a string, becomes an apostrophe. Control characters, line breaks
// among them, are spelled out (base/printable.h): raw, they would end the command or the SVG file.
std::string GnuplotQuote(const std::string& text);

}  // namespace nacre
