// SPDX-License-Identifier: Apache-2.0
#include "report/layout.h"

#include <algorithm>
#include <cmath>

#include "base/printable.h"
#include "image_io/draw_text.h"

namespace nacre {

// ---- Ranges -------------------------------------------------------------------------------------

namespace {

bool IsShown(double value, const Axis& axis) {
  return std::isfinite(value) && (!axis.log || value > 0);
}

// The range of the data; low > high if there is none.
AxisRange DataRange(const Plot& plot, Which which) {
  const Axis& axis = which == Which::kX ? plot.x : plot.y;
  AxisRange range{std::numeric_limits<double>::infinity(),
                  -std::numeric_limits<double>::infinity()};
  for (const Curve& curve : plot.curves) {
    for (const double value : which == Which::kX ? curve.x : curve.y) {
      if (!IsShown(value, axis)) continue;
      range.low = std::min(range.low, value);
      range.high = std::max(range.high, value);
    }
  }
  return range;
}

constexpr double kRounding = 1e-9;  // of a step: a value on a tick must stay on it

// Extends the range to the next ticks.
AxisRange RoundLinear(const AxisRange& range) {
  const double step = NiceStep((range.high - range.low) / 8);
  return {step * std::floor(range.low / step + kRounding),
          step * std::ceil(range.high / step - kRounding)};
}

// Extends the range to 1, 2 or 5 times a power of ten, or, if it has many decades, to whole
// decades.
AxisRange RoundLogarithmic(const AxisRange& range) {
  if (IsManyDecades(range)) {
    return {std::pow(10, std::floor(std::log10(range.low) + kRounding)),
            std::pow(10, std::ceil(std::log10(range.high) - kRounding))};
  }
  // The largest such number up to x is 10 over the smallest one from 10 / x on.
  return {10 / NiceStep(10 / range.low), NiceStep(range.high)};
}

}  // namespace

double PlaceOf(double value, const Axis& axis, const AxisRange& range) {
  if (!axis.log) return (value - range.low) / (range.high - range.low);
  return std::log(value / range.low) / std::log(range.high / range.low);
}

AxisRange RangeOf(const Plot& plot, Which which) {
  const Axis& axis = which == Which::kX ? plot.x : plot.y;
  AxisRange range = DataRange(plot, which);
  if (!(range.low <= range.high)) range = {1, 10};  // nothing to show
  if (range.low == range.high) {
    range = axis.log ? AxisRange{range.low / 10, range.low * 10}
                     : AxisRange{range.low - 1, range.low + 1};
  }
  range = axis.log ? RoundLogarithmic(range) : RoundLinear(range);
  if (std::isfinite(axis.low)) range.low = axis.low;
  if (std::isfinite(axis.high)) range.high = axis.high;
  // If only one end is set and the data is beyond it, the other end is chosen past it.
  if (!(range.low < range.high)) range.high = axis.log ? 10 * range.low : range.low + 1;
  return range;
}

bool IsManyDecades(const AxisRange& range) { return range.high > 300 * range.low; }

double NiceStep(double step) {
  const double decade = std::pow(10, std::floor(std::log10(step)));
  for (const double digit : {1.0, 2.0, 5.0}) {
    if (digit * decade >= step * (1 - 1e-9)) return digit * decade;
  }
  return 10 * decade;
}

void ForEachPlottedPoint(const Plot& plot, const std::function<void(double x, double y)>& call) {
  constexpr double kSpacing = 0.02;
  const AxisRange x_range = RangeOf(plot, Which::kX);
  const AxisRange y_range = RangeOf(plot, Which::kY);
  for (const Curve& curve : plot.curves) {
    double last_x = kFromData;
    double last_y = kFromData;
    for (size_t i = 0; i < curve.x.size(); ++i) {
      if (!IsShown(curve.x[i], plot.x) || !IsShown(curve.y[i], plot.y)) {
        last_x = last_y = kFromData;
        continue;
      }
      const double x = PlaceOf(curve.x[i], plot.x, x_range);
      const double y = PlaceOf(curve.y[i], plot.y, y_range);
      const double length = std::max(std::abs(x - last_x), std::abs(y - last_y));
      const bool joined = length > 0 && curve.style != CurveStyle::kMarks;
      const int steps = joined ? static_cast<int>(std::min(std::ceil(length / kSpacing), 1e3)) : 1;
      for (int step = 1; step < steps; ++step) {
        const double t = static_cast<double>(step) / steps;
        call(last_x + t * (x - last_x), last_y + t * (y - last_y));
      }
      call(x, y);
      last_x = x;
      last_y = y;
    }
  }
}

// ---- Free space ---------------------------------------------------------------------------------

namespace {

// For the fonts that gnuplot draws with, in pixels, a little generous.
constexpr double kGlyphWidth = 11.5;
constexpr double kLineHeight = 31;
constexpr double kAxesWidth = 170, kAxesHeight = 130;  // the size of axes and margins

size_t GlyphCount(const std::string& text) {
  return static_cast<size_t>(std::ranges::count_if(text, [](char c) {
    return (static_cast<unsigned char>(c) & 0xc0) != 0x80;  // not a continuation byte of UTF-8
  }));
}

// The width in a legend, for the same fonts.
double WidthInKey(const std::string& text) {
  constexpr double kTextSize = 25.5;  // pixels: 19 points
  return TextWidth(Printable(text), kTextSize);
}

constexpr std::string_view kSeparator = ", ";

std::vector<std::string> PartsOf(const std::string& title) {
  std::vector<std::string> parts;
  size_t begin = 0;
  for (size_t end; (end = title.find(kSeparator, begin)) != std::string::npos;
       begin = end + kSeparator.size()) {
    parts.push_back(title.substr(begin, end - begin));
  }
  parts.push_back(title.substr(begin));
  return parts;
}

// Title i without the parts that all titles share, except for the first part, the model.
std::string WithoutShared(const std::vector<std::vector<std::string>>& all, size_t i) {
  std::string title = all[i].front();
  bool left_out = false;
  for (size_t k = 1; k < all[i].size(); ++k) {
    const std::string& part = all[i][k];
    const bool shared = std::ranges::all_of(all, [&](const std::vector<std::string>& other) {
      return std::ranges::find(other, part) != other.end();
    });
    if (!shared || !left_out) title += std::string(kSeparator) + (shared ? "…" : part);
    left_out = shared;
  }
  return title;
}

// The start of the character that contains byte `at`.
size_t CharacterStart(const std::string& text, size_t at) {
  while (at > 0 && at < text.size() && (static_cast<unsigned char>(text[at]) & 0xc0) == 0x80) --at;
  return at;
}

// Replaces as much of the middle as necessary by an ellipsis. More is kept of the end than of the
// beginning.
std::string WithoutMiddle(const std::string& text, double room) {
  const auto cut = [&](size_t kept) {
    const size_t head = CharacterStart(text, kept / 3);
    const size_t tail = CharacterStart(text, text.size() - (kept - kept / 3));
    return text.substr(0, head) + "…" + text.substr(tail);
  };
  size_t fits = 0, too_many = text.size();
  while (fits + 1 < too_many) {
    const size_t kept = (fits + too_many) / 2;
    (WidthInKey(cut(kept)) > room ? too_many : fits) = kept;
  }
  return cut(fits);
}

// The distance of a box from the nearest corner.
double DistanceToCorner(const PlotBox& box) {
  const double x = std::min(box.x0, 1 - box.x1);
  const double y = std::min(box.y0, 1 - box.y1);
  return x * x + y * y;
}

}  // namespace

PlotLayout::PlotLayout(const Plot& plot, int width, int height)
    : inner_width_(std::max(width - kAxesWidth, 50.0)),
      inner_height_(std::max(height - kAxesHeight, 50.0)) {
  if (plot.polar) return;
  ForEachPlottedPoint(plot, [&](double x, double y) { points_.emplace_back(x, y); });
}

double PlotLayout::TextWidth(const std::string& text) const {
  return kGlyphWidth * static_cast<double>(GlyphCount(text)) / inner_width_;
}

double PlotLayout::LineHeight() const { return kLineHeight / inner_height_; }

bool PlotLayout::IsFree(const PlotBox& box) const {
  const auto inside = [&](const std::pair<double, double>& point) {
    return point.first > box.x0 && point.first < box.x1 && point.second > box.y0 &&
           point.second < box.y1;
  };
  const auto overlaps = [&](const PlotBox& other) {
    return other.x0 < box.x1 && box.x0 < other.x1 && other.y0 < box.y1 && box.y0 < other.y1;
  };
  return std::ranges::none_of(points_, inside) && std::ranges::none_of(boxes_, overlaps);
}

void PlotLayout::Occupy(const PlotBox& box) { boxes_.push_back(box); }

std::optional<PlotBox> PlotLayout::FindRoom(double width, double height) const {
  constexpr int kSteps = 24;
  std::optional<PlotBox> best;
  for (int i = kSteps; i >= 0; --i) {
    const double y = (1 - height) * i / kSteps;
    for (int j = 0; j <= kSteps; ++j) {
      const double x = (1 - width) * j / kSteps;
      const PlotBox box{x, y, x + width, y + height};
      // The tolerance keeps rounding errors from deciding.
      if (best && DistanceToCorner(box) > DistanceToCorner(*best) - 1e-9) continue;
      if (IsFree(box)) best = box;
    }
  }
  return best;
}

PlotBox RoomBesideColumn(const PlotLayout& layout, double x, double width) {
  const double gap = 0.7 * layout.TextWidth("x");
  const double height = layout.LineHeight();
  std::optional<PlotBox> first;
  for (double y = 0.99; y > height; y -= height / 2) {
    for (const double x0 : {x + gap, x - gap - width}) {
      const PlotBox box{x0, y - height, x0 + width, y};
      if (x0 < 0 || x0 + width > 1) continue;
      if (layout.IsFree(box)) return box;
      if (!first) first = box;
    }
  }
  return first.value_or(PlotBox{x, 0.99 - height, x + width, 0.99});
}

PlotBox RoomAboveRow(const PlotLayout& layout, double y, double width) {
  const double height = layout.LineHeight();
  const double y0 = y + height > 1 ? y - height : y;
  for (double x = 0.99; x > width; x -= 0.02) {
    const PlotBox box{x - width, y0, x, y0 + height};
    // A curve may coincide with the line itself, so only the space above it is tested.
    if (layout.IsFree({box.x0, y0 + 0.1 * height, box.x1, box.y1})) return box;
  }
  return {0.99 - width, y0, 0.99, y0 + height};
}

std::vector<std::string> KeyTitles(const Plot& plot, int width) {
  constexpr double kBeside = 150;  // pixels for the line sample and margins
  const double room = std::max(width - kBeside, 50.0);
  std::vector<std::string> titles;
  std::vector<std::vector<std::string>> all;
  for (const Curve& curve : plot.curves) {
    titles.push_back(curve.title);
    if (!curve.title.empty()) all.push_back(PartsOf(curve.title));
  }
  const auto too_wide = [&](const std::string& title) { return WidthInKey(title) > room; };
  if (std::ranges::none_of(titles, too_wide)) return titles;
  size_t i = 0;
  for (std::string& title : titles) {
    if (title.empty()) continue;
    if (all.size() > 1) title = WithoutShared(all, i++);
    if (too_wide(title)) title = WithoutMiddle(title, room);
  }
  return titles;
}

std::optional<PlotBox> FindKeyRoom(const Plot& plot, const PlotLayout& layout) {
  constexpr double kSample = 12;  // width of the line sample and its margins in glyphs
  double longest = 0;
  int lines = 0;
  for (const Curve& curve : plot.curves) {
    longest = std::max(longest, layout.TextWidth(curve.title));
    lines += !curve.title.empty();
  }
  const double width = longest + kSample * layout.TextWidth("x");
  const double height = layout.LineHeight() * (lines + 0.5);
  if (plot.polar || width > 0.95 || height > 0.95) return std::nullopt;
  return layout.FindRoom(width, height);
}

}  // namespace nacre
