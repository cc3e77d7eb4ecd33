// SPDX-License-Identifier: Apache-2.0
// report/plot.h: diagrams: curves over an axis, in one or several panels, as SVG, PNG and CSV.
//
// gnuplot draws them (the Debian package gnuplot-nox), started without a shell and fed the data.
// Texts are UTF-8 and mean what they say: no markup, so names with underscores stay as they are.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace nacre {

inline constexpr double kFromData = std::numeric_limits<double>::quiet_NaN();

struct Axis {
  std::string label;  // with its unit: "angle from the normal (degrees)"
  bool log = false;   // values <= 0 are left out
  double low = kFromData;
  double high = kFromData;
  double step = kFromData;  // between labelled ticks; chosen by gnuplot if it is not a number
};

enum class CurveStyle : uint8_t {
  kLine,
  kMarkedLine,  // a mark at each point
  kMarks,
};

// y over x, in the order given; where either is not finite the line is broken. Curves differ in
// colour (Okabe and Ito 2008, told apart with any kind of colour vision) and in dash or mark. The
// key of their titles stands where it hides none of them, or else below the plot.
struct Curve {
  std::string title;  // in the key; none if empty
  std::vector<double> x, y;
  CurveStyle style = CurveStyle::kLine;
  int look = -1;  // number of its colour, dash and mark; -1: the curve's place in the plot
};

// A thin line across the plot at a value of one axis (of a polar plot: a ray at an angle), with a
// word beside it.
struct Rule {
  enum class Across : uint8_t { kX, kY };
  Across across = Across::kX;  // kX: a vertical line at a value of x
  double at = 0;
  std::string label;
};

// A value for each point of an even grid over both axes, as colours: those of the heat maps
// (compare/heat_map.h), by the logarithm. Points are given row by row, and have no other place.
struct Field {
  std::string label;  // of the scale beside it, with its unit
  std::vector<double> x, y, values;
  double low = 1e-4, high = 1;  // ends of the scale; values beyond have the colours of the ends
};

struct Plot {
  std::string title;
  Axis x, y;
  std::vector<Curve> curves;
  std::vector<Rule> rules;
  std::optional<Field> field;  // below the curves; both axes then say what they show
  // x is an angle in degrees in [-90, 90], 0 upwards and growing to the right; y the radius.
  bool polar = false;
};

// Panels from left to right, `columns` in a row.
struct Figure {
  std::vector<Plot> panels;
  int columns = 1;
  int width = 1280, height = 800;  // pixels
  std::string title;               // above several panels
};

// One plot of the usual size.
Figure MakeFigure(Plot plot);
// Two or three of them side by side.
Figure MakeRow(std::vector<Plot> plots);

// A text as a cell of a CSV file that needs no quotes, which numpy's readers do not know: commas
// become semicolons, double quotes single ones, line ends spaces; '#', which begins a comment
// there, goes.
std::string CsvText(const std::string& text);

// All numbers of the figure, to the last digit. For each field: columns of x, y and the value. For
// each run of curves with equal x: a column of x, then one for each curve. The first line names
// them. Numbers that are not finite are empty.
std::string FigureCsv(const Figure& figure);

// ".svg", ".png" or ".csv". Throws Error (kUsage) for others.
void CheckFigurePath(const std::string& path);

// Throws Error (kInternal) if gnuplot is missing.
void CheckPlotter();

// Writes the figure, as its path's extension says, whole or not at all. Throws Error: kUsage for an
// unknown extension, kCannotWrite, kInternal if gnuplot is missing or fails.
void WriteFigure(const std::string& path, const Figure& figure);

}  // namespace nacre
