// SPDX-License-Identifier: Apache-2.0
#include "report/plot.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "base/path.h"
#include "image_io/output_file.h"
#include "report/child_process.h"
#include "report/gnuplot.h"

namespace nacre {
namespace {

// A column of a table of numbers.
struct Column {
  std::string name;
  const std::vector<double>* values;
};

std::vector<Column> ColumnsOf(const Figure& figure) {
  std::vector<Column> columns;
  for (const Plot& plot : figure.panels) {
    const std::string prefix =
        figure.panels.size() > 1 && !plot.title.empty() ? plot.title + ": " : "";
    if (plot.field) {
      columns.push_back({prefix + plot.x.label, &plot.field->x});
      columns.push_back({prefix + plot.y.label, &plot.field->y});
      columns.push_back({prefix + plot.field->label, &plot.field->values});
    }
    const std::vector<double>* x = nullptr;
    for (const Curve& curve : plot.curves) {
      const std::string x_name =
          plot.x.label.empty() && plot.polar ? "angle (degrees)" : plot.x.label;
      if (x == nullptr || *x != curve.x) columns.push_back({prefix + x_name, &curve.x});
      x = &curve.x;
      columns.push_back({prefix + (curve.title.empty() ? plot.y.label : curve.title), &curve.y});
    }
  }
  return columns;
}

[[noreturn]] void FailMissing() {
  throw Error(ExitCode::kCannotWrite, "", "gnuplot is missing, and it draws the plots",
              "install the package gnuplot-nox (scripts/setup does), or write .csv");
}

// Escapes "&#x" and "]]>" in texts, which are markup in XML and which gnuplot writes unescaped.
std::string EscapeLeftOut(std::string svg) {
  for (const auto& [text, escaped] : {std::pair{"&#x", "&amp;#x"}, std::pair{"]]>", "]]&gt;"}}) {
    for (size_t at = svg.find(text); at != std::string::npos; at = svg.find(text, at + 1)) {
      svg.replace(at, 3, escaped);
    }
  }
  return svg;
}

std::string Draw(const Figure& figure, PictureFormat format) {
  // -d: ignores the user's settings for gnuplot.
  const ChildResult result = RunChild({"gnuplot", "-d"}, GnuplotScript(figure, format));
  if (!result.found) FailMissing();
  if (result.status != 0 || result.output.empty()) {
    constexpr size_t kEnough = 500;  // the last lines tell what is wrong
    const size_t begin = result.errors.size() > kEnough ? result.errors.size() - kEnough : 0;
    throw Error(
        ExitCode::kInternal, "gnuplot",
        fmt::format("ended with status {}: {}", result.status, result.errors.substr(begin)));
  }
  return format == PictureFormat::kSvg ? EscapeLeftOut(result.output) : result.output;
}

}  // namespace

std::vector<double> Steps(double from, double to, int count) {
  std::vector<double> values;
  for (int i = 0; i <= count; ++i) values.push_back(from + (to - from) * i / count);
  return values;
}

Curve MakeCurve(const std::string& title, std::vector<double> x,
                const std::function<double(double)>& f) {
  std::vector<double> y;
  for (const double value : x) y.push_back(f(value));
  return {title, std::move(x), std::move(y)};
}

Figure MakeFigure(Plot plot) { return {.panels = {std::move(plot)}}; }

Figure MakeRow(std::vector<Plot> plots) {
  const auto columns = static_cast<int>(plots.size());
  return {.panels = std::move(plots), .columns = columns, .width = 1700, .height = 760};
}

std::string CsvText(const std::string& text) {
  std::string plain;
  for (const char c : text) {
    if (c == '#') continue;
    plain += c == ',' ? ';' : c == '"' ? '\'' : c == '\r' || c == '\n' ? ' ' : c;
  }
  return plain;
}

std::string FigureCsv(const Figure& figure) {
  const std::vector<Column> columns = ColumnsOf(figure);
  std::string text;
  size_t rows = 0;
  for (size_t c = 0; c < columns.size(); ++c) {
    if (c > 0) text += ",";
    text += CsvText(columns[c].name);
    rows = std::max(rows, columns[c].values->size());
  }
  text += "\n";
  for (size_t row = 0; row < rows; ++row) {
    for (size_t c = 0; c < columns.size(); ++c) {
      const std::vector<double>& values = *columns[c].values;
      if (c > 0) text += ",";
      if (row < values.size() && std::isfinite(values[row])) text += fmt::format("{}", values[row]);
    }
    text += "\n";
  }
  return text;
}

void CheckFigurePath(const std::string& path) {
  for (const char* extension : {".svg", ".png", ".csv"}) {
    if (HasExtension(path, extension)) return;
  }
  throw Error(ExitCode::kUsage, path, "unknown output extension",
              "plots are written as .svg, .png and .csv");
}

void CheckPlotter() {
  if (!FindProgram("gnuplot")) FailMissing();
}

void WriteFigure(const std::string& path, const Figure& figure) {
  CheckFigurePath(path);
  OutputFile file(path);  // opened before gnuplot does any work
  const std::string text = HasExtension(path, ".csv")   ? FigureCsv(figure)
                           : HasExtension(path, ".svg") ? Draw(figure, PictureFormat::kSvg)
                                                        : Draw(figure, PictureFormat::kPng);
  file.Write(0, std::span(reinterpret_cast<const uint8_t*>(text.data()), text.size()));
  file.Commit();
}

}  // namespace nacre
