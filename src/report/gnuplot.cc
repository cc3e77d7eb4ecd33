// SPDX-License-Identifier: Apache-2.0
#include "report/gnuplot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "base/printable.h"
#include "compare/heat_map.h"
#include "report/layout.h"

namespace nacre {
namespace {

// Okabe and Ito 2008 without yellow, which is pale on white; the same as in the benchmarks'
// diagrams.
constexpr std::array<std::string_view, 8> kColors = {"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                                     "#000000", "#E69F00", "#56B4E9", "#999999"};
// Lengths of strokes and gaps; neighbours look different in grey.
constexpr std::array<std::string_view, 8> kDashes = {
    "solid", "(12,5)", "(3,4)", "(12,4,3,4)", "(20,5)", "(6,4)", "(3,3,3,8)", "(12,4,3,4,3,4)"};
constexpr std::array<int, 8> kPoints = {7, 5, 9, 11, 13, 6, 4, 8};  // gnuplot's point types

constexpr std::string_view kCommon = R"(set encoding utf8
set border 3 lw 1.5 lc rgb '#555555'
set tics nomirror out scale 0.6 textcolor rgb '#222222'
set grid lw 1 lt 1 lc rgb '#dddddd'
)";
constexpr std::string_view kGrey = "rgb '#666666'";

// Indices of the colour and of the dash and mark, combined so that 64 curves differ.
struct Look {
  size_t color, form;
};

Look LookOf(const Curve& curve, size_t place) {
  const size_t look = curve.look >= 0 ? static_cast<size_t>(curve.look) : place;
  return {look % kColors.size(), (look + look / kColors.size()) % kDashes.size()};
}

std::string Number(double value) {
  return std::isfinite(value) ? fmt::format("{:.9g}", value) : "NaN";
}

std::string BlockName(size_t panel, size_t curve) { return fmt::format("$p{}c{}", panel, curve); }

// The data of a curve. Points that a logarithmic axis cannot show are left out.
std::string DataBlock(const std::string& name, const Plot& plot, const Curve& curve) {
  std::string text = name + " << EOD\n";
  for (size_t i = 0; i < curve.x.size(); ++i) {
    double x = curve.x[i];
    double y = curve.y[i];
    if (plot.polar) {
      const double angle = x * M_PI / 180;
      x = y * std::sin(angle);
      y = y * std::cos(angle);
    } else if ((plot.x.log && !(x > 0)) || (plot.y.log && !(y > 0))) {
      y = kFromData;
    }
    // A blank line interrupts the curve.
    text +=
        std::isfinite(x) && std::isfinite(y) ? fmt::format("{} {}\n", Number(x), Number(y)) : "\n";
  }
  return text + "EOD\n";
}

std::string CirclesName(size_t panel) { return fmt::format("$p{}g", panel); }

// The circles of a polar plot, equally spaced. The outermost one is the smallest that encloses all
// curves.
struct Circles {
  double step, end;
};

Circles CirclesOf(const Plot& plot) {
  const AxisRange radius = RangeOf(plot, Which::kY);
  const double step = std::isfinite(plot.y.step) ? plot.y.step : NiceStep(radius.high / 6);
  const double end =
      std::isfinite(plot.y.high) ? plot.y.high : step * std::ceil(radius.high / step - 1e-9);
  return {step, end};
}

// Draws half circles as curves. gnuplot omits circles from SVG files that reach out of the plot's
// rectangle, as the lower halves would.
std::string CirclesBlock(const std::string& name, const Plot& plot) {
  const auto [step, end] = CirclesOf(plot);
  std::string text = name + " << EOD\n";
  for (int i = 1; i * step <= end * (1 + 1e-9); ++i) {
    for (int degrees = -90; degrees <= 90; degrees += 2) {
      const double angle = degrees * M_PI / 180;
      text += fmt::format("{} {}\n", Number(i * step * std::sin(angle)),
                          Number(i * step * std::cos(angle)));
    }
    text += "\n";
  }
  return text + "EOD\n";
}

std::string FieldName(size_t panel) { return fmt::format("$p{}f", panel); }

// The data of a field. Its scale is logarithmic, so values are clamped to its ends.
std::string FieldBlock(const std::string& name, const Field& field) {
  std::string text = name + " << EOD\n";
  for (size_t i = 0; i < field.values.size(); ++i) {
    const double value = std::isfinite(field.values[i])
                             ? std::clamp(field.values[i], field.low, field.high)
                             : field.values[i];
    text += fmt::format("{} {} {}\n", Number(field.x[i]), Number(field.y[i]), Number(value));
  }
  return text + "EOD\n";
}

// The colours of heat maps, and the scale beside the plot.
std::string FieldText(const Field& field) {
  constexpr int kSteps = 9;  // HeatColor is linear between ten colours
  std::string palette;
  for (int i = 0; i <= kSteps; ++i) {
    const Rgb8 c = HeatColor(static_cast<double>(i) / kSteps);
    palette += fmt::format("{}{} '#{:02x}{:02x}{:02x}'", i == 0 ? "" : ", ", i, c[0], c[1], c[2]);
  }
  return fmt::format(
      "set palette defined ({})\nset logscale cb\nset cbrange [{}:{}]\nset format cb '10^{{%T}}'\n"
      "set cblabel {} noenhanced textcolor rgb '#222222' offset 0.8,0\nset rmargin 9\n",
      palette, Number(field.low), Number(field.high), GnuplotQuote(field.label));
}

std::string CurveStyleText(const Curve& curve, size_t place) {
  const Look look = LookOf(curve, place);
  const std::string line = fmt::format("lc rgb '{}' lw 3", kColors[look.color]);
  const std::string mark = fmt::format("pt {} ps 1.3", kPoints[look.form]);
  switch (curve.style) {
    case CurveStyle::kMarkedLine:
      return fmt::format("with linespoints {} {}", line, mark);
    case CurveStyle::kMarks:
      return fmt::format("with points {} {}", line, mark);
    case CurveStyle::kLine:
      break;
  }
  return fmt::format("with lines {} dt {}", line, kDashes[look.form]);
}

std::string AxisText(char name, const Axis& axis, const AxisRange& range) {
  std::string text = fmt::format("set {}label {} noenhanced\n", name, GnuplotQuote(axis.label));
  text += fmt::format("{} logscale {}\n", axis.log ? "set" : "unset", name);
  text += fmt::format("set {}range [{}:{}]\n", name, Number(range.low), Number(range.high));
  text += fmt::format("set {}tics autofreq\n", name);
  if (!axis.log) {
    text += fmt::format("set format {} '%h'\n", name);
    if (std::isfinite(axis.step)) text += fmt::format("set {}tics {}\n", name, Number(axis.step));
    return text;
  }
  if (IsManyDecades(range)) {
    return text + fmt::format("set format {} '10^{{%T}}'\n", name);
  }
  text += fmt::format("set format {} '%h'\nset {}tics (", name, name);
  const char* separator = "";
  for (double decade = std::pow(10, std::floor(std::log10(range.low))); decade <= range.high;
       decade *= 10) {
    for (const int digit : {1, 2, 5}) {
      text += fmt::format("{}{}", separator, Number(digit * decade));
      separator = ", ";
    }
  }
  return text + ")\n";
}

// The position of a rule in the plot.
double PlaceOf(const Plot& plot, const Rule& rule) {
  return rule.across == Rule::Across::kX ? PlaceOf(rule.at, plot.x, RangeOf(plot, Which::kX))
                                         : PlaceOf(rule.at, plot.y, RangeOf(plot, Which::kY));
}

PlotBox LineOf(const Plot& plot, const Rule& rule) {
  constexpr double kHalfWidth = 1e-3;
  const double place = PlaceOf(plot, rule);
  if (rule.across == Rule::Across::kX) return {place - kHalfWidth, 0, place + kHalfWidth, 1};
  return {0, place - kHalfWidth, 1, place + kHalfWidth};
}

// To be called after RuleText, so that `layout` contains the rules' labels.
std::string KeyText(const Plot& plot, const PlotLayout& layout) {
  const auto titled = [](const Curve& curve) { return !curve.title.empty(); };
  if (std::ranges::none_of(plot.curves, titled)) return "unset key\n";
  constexpr std::string_view kLook =
      "Left reverse noenhanced textcolor rgb '#222222' samplen 3 spacing 1.15";
  PlotLayout beside_rules = layout;
  for (const Rule& rule : plot.rules) beside_rules.Occupy(LineOf(plot, rule));
  std::optional<PlotBox> room = FindKeyRoom(plot, beside_rules);
  if (!room) room = FindKeyRoom(plot, layout);
  if (!room) return fmt::format("set key outside below center horizontal height 1.5 {}\n", kLook);
  // Anchors the legend at the corner of its box that is nearest to a corner of the plot.
  const bool right = room->x0 + room->x1 > 1;
  const bool top = room->y0 + room->y1 > 1;
  return fmt::format("set key at graph {},graph {} {} {} vertical {}\n",
                     Number(right ? room->x1 : room->x0), Number(top ? room->y1 : room->y0),
                     top ? "top" : "bottom", right ? "right" : "left", kLook);
}

// A line across the plot, with its label beside it, where it hides no curve if possible.
std::string RuleText(const Plot& plot, const Rule& rule, PlotLayout* layout) {
  const bool vertical = rule.across == Rule::Across::kX;
  const std::string at = Number(rule.at);
  const std::string look = fmt::format("nohead lw 1.5 dt (5,4) lc {} back\n", kGrey);
  std::string text =
      vertical ? fmt::format("set arrow from first {0},graph 0 to first {0},graph 1 {1}", at, look)
               : fmt::format("set arrow from graph 0,first {0} to graph 1,first {0} {1}", at, look);
  if (rule.label.empty()) return text;
  const double place = PlaceOf(plot, rule);
  const PlotBox box = vertical ? RoomBesideColumn(*layout, place, layout->TextWidth(rule.label))
                               : RoomAboveRow(*layout, place, layout->TextWidth(rule.label));
  layout->Occupy(box);
  return text + fmt::format(
                    "set label {} at graph {},graph {} center noenhanced textcolor {} font "
                    "',16' front\n",
                    GnuplotQuote(rule.label), Number((box.x0 + box.x1) / 2),
                    Number((box.y0 + box.y1) / 2), kGrey);
}

// Rays under the curves and values of the circles, which replace axes.
std::string PolarText(const Plot& plot) {
  const auto [step, end] = CirclesOf(plot);
  std::string text = fmt::format(
      "unset border\nunset tics\nunset grid\nunset logscale\nset size ratio -1\n"
      "set xrange [{0}:{1}]\nset yrange [{2}:{1}]\nset xlabel {3} noenhanced\nset ylabel ''\n",
      Number(-1.13 * end), Number(1.13 * end), Number(-0.12 * end), GnuplotQuote(plot.y.label));
  for (int degrees = -90; degrees <= 90; degrees += 15) {
    const double x = std::sin(degrees * M_PI / 180);
    const double y = std::cos(degrees * M_PI / 180);
    text += fmt::format("set arrow from 0,0 to {},{} nohead lw 1 lc rgb '#dddddd' back\n",
                        Number(end * x), Number(end * y));
    if (degrees % 30 != 0) continue;
    text += fmt::format("set label '{}°' at {},{} center textcolor rgb '#222222'\n",
                        std::abs(degrees), Number(1.07 * end * x), Number(1.06 * end * y));
  }
  for (int i = 1; i * step <= end * (1 + 1e-9); ++i) {
    text += fmt::format(
        "set label '{0}' at {0},0 center offset 0,-0.8 textcolor rgb '#222222' font ',16'\n",
        Number(i * step));
  }
  for (const Rule& rule : plot.rules) {
    const double x = end * std::sin(rule.at * M_PI / 180);
    const double y = end * std::cos(rule.at * M_PI / 180);
    text +=
        fmt::format("set arrow from {},{} to 0,0 lw 2 lc {} front\n", Number(x), Number(y), kGrey);
    // Above the ray and inside the outermost circle, since the angles are outside.
    const double above = std::copysign(0.04, -rule.at);
    text += fmt::format("set label {} at {},{} center noenhanced textcolor {} font ',16' front\n",
                        GnuplotQuote(rule.label), Number(0.88 * x + above * y),
                        Number(0.88 * y - above * x), kGrey);
  }
  return text;
}

std::string PanelText(const Figure& figure, size_t index, int width, int height) {
  Plot plot = figure.panels[index];
  const std::vector<std::string> titles = KeyTitles(plot, width);
  for (size_t i = 0; i < titles.size(); ++i) plot.curves[i].title = titles[i];
  PlotLayout layout(plot, width, height);
  std::string text = std::string(kCommon) + "unset label\nunset arrow\nunset object\n";
  text += "set size noratio\n";
  text += fmt::format("set title {} noenhanced offset 0,-0.4\n", GnuplotQuote(plot.title));
  if (plot.polar) {
    text += PolarText(plot);
  } else {
    text += AxisText('x', plot.x, RangeOf(plot, Which::kX));
    text += AxisText('y', plot.y, RangeOf(plot, Which::kY));
    for (const Rule& rule : plot.rules) text += RuleText(plot, rule, &layout);
  }
  text += KeyText(plot, layout);
  std::string curves;
  if (plot.polar) {
    curves = CirclesName(index) + " using 1:2 with lines lc rgb '#cccccc' lw 1 notitle";
  }
  if (plot.field) {
    text += FieldText(*plot.field);
    curves = FieldName(index) + " using 1:2:3 with image notitle";
  }
  for (size_t i = 0; i < plot.curves.size(); ++i) {
    const Curve& curve = plot.curves[i];
    const std::string title =
        curve.title.empty() ? "notitle" : "title " + GnuplotQuote(curve.title);
    curves += fmt::format("{}{} using 1:2 {} {}", curves.empty() ? "" : ", ", BlockName(index, i),
                          CurveStyleText(curve, i), title);
  }
  return text + "plot " + (curves.empty() ? "NaN notitle" : curves) + "\n";
}

}  // namespace

std::string GnuplotQuote(const std::string& text) {
  std::string quoted = "'";
  for (const char& c : Printable(text)) quoted += c == '\'' ? "’" : std::string_view(&c, 1);
  return quoted + "'";
}

std::string GnuplotScript(const Figure& figure, PictureFormat format) {
  const int columns = std::max(figure.columns, 1);
  const int count = static_cast<int>(figure.panels.size());
  const int rows = std::max((count + columns - 1) / columns, 1);
  std::string text =
      fmt::format("set terminal {} size {},{} font 'DejaVu Sans,19' background rgb 'white'\n",
                  format == PictureFormat::kSvg ? "svg" : "pngcairo", figure.width, figure.height);
  for (size_t p = 0; p < figure.panels.size(); ++p) {
    const Plot& plot = figure.panels[p];
    if (plot.field) text += FieldBlock(FieldName(p), *plot.field);
    if (plot.polar) text += CirclesBlock(CirclesName(p), plot);
    for (size_t c = 0; c < plot.curves.size(); ++c) {
      text += DataBlock(BlockName(p, c), plot, plot.curves[c]);
    }
  }
  if (count > 1) {
    text += fmt::format("set multiplot layout {},{} title {} noenhanced\n", rows, columns,
                        GnuplotQuote(figure.title));
  }
  for (size_t p = 0; p < figure.panels.size(); ++p) {
    text += PanelText(figure, p, figure.width / columns, figure.height / rows);
  }
  if (count > 1) text += "unset multiplot\n";
  return text;
}

}  // namespace nacre
