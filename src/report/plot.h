// SPDX-License-Identifier: Apache-2.0
// report/plot.h: draws diagrams (figure.h) as SVG, PNG and CSV. gnuplot (the Debian package
// gnuplot-nox) draws them; it is started without a shell and gets the data as input.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "report/figure.h"

namespace nacre {

// `count` + 1 numbers at equal distances, both ends included.
std::vector<double> Steps(double from, double to, int count);
// y = f(x) over these x.
Curve MakeCurve(const std::string& title, std::vector<double> x,
                const std::function<double(double)>& f);

// A figure of one plot, of the usual size.
Figure MakeFigure(Plot plot);
// A figure of two or three plots side by side.
Figure MakeRow(std::vector<Plot> plots);

// Makes a text a cell of a CSV file that needs no quotes, which numpy's readers do not support:
// commas become semicolons, double quotes single ones, line ends spaces; '#', which begins a
// comment there, is removed.
std::string CsvText(const std::string& text);

// All numbers of the figure with all digits. Each field gives columns of x, y and the value. Each
// run of curves with equal x gives a column of x and one for each curve. The first line names the
// columns. Numbers that are not finite are empty cells.
std::string FigureCsv(const Figure& figure);

// Checks the extension, ".svg", ".png" or ".csv". Throws Error (kUsage) for others.
void CheckFigurePath(const std::string& path);

// Throws Error (kInternal) if gnuplot is missing.
void CheckPlotter();

// Writes the figure in the format of the path's extension; the file appears completely or not at
// all. Throws Error: kUsage for an unknown extension, kCannotWrite, kInternal if gnuplot is missing
// or fails.
void WriteFigure(const std::string& path, const Figure& figure);

}  // namespace nacre
