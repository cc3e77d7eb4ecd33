// SPDX-License-Identifier: Apache-2.0
// report/figure.h: diagrams as data: curves over an axis, in one or several panels. Texts are UTF-8
// and literal, without markup, so names with underscores stay as they are.
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
  double step = kFromData;  // between labelled ticks; if not a number, gnuplot chooses
};

enum class CurveStyle : uint8_t {
  kLine,
  kMarkedLine,  // a mark at each point
  kMarks,
};

// y over x, in the order given; the line is interrupted where either is not finite. Curves differ
// in colour (Okabe and Ito 2008, distinguishable with any colour vision) and in dash or mark. The
// legend is placed where it hides no curve, or else below the plot.
struct Curve {
  std::string title;  // in the legend; empty: not listed
  std::vector<double> x, y;
  CurveStyle style = CurveStyle::kLine;
  int look = -1;  // index of colour, dash and mark; -1: the curve's index in the plot
};

// A thin line across the plot at a value of one axis, with a label beside it. In a polar plot, a
// ray at an angle.
struct Rule {
  enum class Across : uint8_t { kX, kY };
  Across across = Across::kX;  // kX: a vertical line at a value of x
  double at = 0;
  std::string label;
};

// A value for each point of a regular grid over both axes, shown by the colours of heat maps
// (compare/heat_map.h) on a logarithmic scale. Points must be given row by row.
struct Field {
  std::string label;  // of the colour scale, with its unit
  std::vector<double> x, y, values;
  double low = 1e-4, high = 1;  // ends of the scale, to which values are clamped
};

struct Plot {
  std::string title;
  Axis x, y;
  std::vector<Curve> curves;
  std::vector<Rule> rules;
  std::optional<Field> field;  // under the curves; both axes must then set their ranges
  // x is an angle in degrees in [-90, 90], 0 upwards and increasing to the right; y is the radius.
  bool polar = false;
};

// Panels from left to right, `columns` per row.
struct Figure {
  std::vector<Plot> panels{};
  int columns = 1;
  int width = 1280, height = 800;  // pixels
  std::string title{};             // above several panels
};

}  // namespace nacre
