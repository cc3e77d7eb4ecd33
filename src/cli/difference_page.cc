// SPDX-License-Identifier: Apache-2.0
#include "cli/difference_page.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "cli/outputs.h"
#include "cli/progress.h"
#include "cli/usage_error.h"
#include "color/display.h"
#include "compare/heat_map.h"
#include "image_io/canvas.h"
#include "image_io/png_writer.h"
#include "render/render.h"

namespace nacre {
namespace {

// Heights of the strip below the cells, in multiples of the text size. The measures and the scale
// are side by side, or, where the cells are too narrow for both, the scale is below the measures.
constexpr double kStrip = 4.6, kTallStrip = 8.2;
constexpr double kMeasureLine = 1.35;  // line spacing, in multiples of the text size
constexpr double kScaleText = 0.8;     // in multiples of the text size
constexpr const char* kScaleCaption = "largest of the channels, linear";

// Renders one sphere into a square of `side` pixels.
Image RenderPanel(const Json& material, int side, const SheetOptions& sheet,
                  const RenderOptions& options, const Lighting& lighting,
                  const std::string& command, const std::vector<std::string>& outputs) {
  SheetPage page;
  page.width = page.height = side;
  page.cell = side;
  const Json shapes = Json::array({SheetSphere(0, material)});
  RenderOptions alone = options;
  alone.size.clear();
  const std::string text = SheetScene(shapes, Json::object(), SheetRequest{}, page, lighting);
  LoadOptions load = MakeLoadOptions(alone);
  std::vector<std::string> read;
  load.on_file = [&](const std::filesystem::path& file) { read.push_back(file.string()); };
  const Scene scene = LoadSheet(text, command, sheet, page, load);
  CheckOutputsAreNoInputs(outputs, read);
  RenderSettings settings = MakeRenderSettings(options);
  settings.on_progress = [](double) { ThrowIfStopped(); };
  return RenderImage(scene, settings);
}

DifferenceMeasures Measure(const Image& a, const Image& b) {
  DifferenceMeasures measures;
  const std::vector<float>& alpha = a.Find("A")->samples;
  double squares = 0;
  double sum = 0;
  size_t count = 0;
  for (const char* name : {"R", "G", "B"}) {
    const std::vector<float>& x = a.Find(name)->samples;
    const std::vector<float>& y = b.Find(name)->samples;
    for (size_t i = 0; i < x.size(); ++i) {
      if (!(alpha[i] > 0)) continue;
      const double difference = static_cast<double>(x[i]) - static_cast<double>(y[i]);
      squares += difference * difference;
      sum += difference;
      measures.max = std::max(measures.max, std::abs(difference));
      ++count;
    }
  }
  if (count > 0) {
    measures.rmse = std::sqrt(squares / static_cast<double>(count));
    measures.mean = sum / static_cast<double>(count);
  }
  return measures;
}

// A scale of four decades up to the power of ten above the largest difference.
HeatScale ScaleFor(double max) {
  HeatScale scale;
  scale.high = max > 0 ? std::pow(10, std::ceil(std::log10(max))) : 1;
  scale.low = 1e-4 * scale.high;
  return scale;
}

// Colours each pixel by the largest difference of its channels, blended with `ground` by coverage.
Rgb8Picture ShowDifference(const Image& a, const Image& b, const HeatScale& scale,
                           const Rgb8& ground, int side) {
  Rgb8Picture picture{side, side, {}};
  const std::vector<float>& alpha = a.Find("A")->samples;
  for (size_t i = 0; i < alpha.size(); ++i) {
    double worst = 0;
    for (const char* name : {"R", "G", "B"}) {
      worst = std::max(worst, std::abs(static_cast<double>(a.Find(name)->samples[i]) -
                                       static_cast<double>(b.Find(name)->samples[i])));
    }
    const Rgb8 color = worst > 0 ? HeatColor(scale.Position(worst)) : kHeatEqual;
    const double covered = std::clamp(double{alpha[i]}, 0.0, 1.0);
    for (size_t c = 0; c < 3; ++c) {
      const double code = color[c] * covered + ground[c] * (1 - covered);
      picture.rgb8.push_back(static_cast<uint8_t>(std::lround(code)));
    }
  }
  return picture;
}

// The distance of measures and scale from the sides of the cells.
double StripInset(const SheetPage& page) { return (0.5 - kSheetSphereRadius) * page.cell; }

// Whether the caption below the third cell would overlap the measures, or leave the page.
bool IsTooNarrow(const SheetPage& page) {
  const double em = page.text_px;
  const double measures = page.left + StripInset(page) + DrawnWidth("mean of A - B -8.888e-88", em);
  const double caption = DrawnWidth(kScaleCaption, kScaleText * em);
  const double center = page.left + 2.5 * page.cell;
  return center - caption / 2 < measures + em / 2 || center + caption / 2 > page.width;
}

// The number of powers of ten from one label of a bar to the next, 1, 2 or 4, so that labels do
// not touch.
int LabelStep(int low, double width, double size) {
  for (const int step : {1, 2}) {
    bool apart = true;
    double end = -size;  // of the label before
    for (int power = low; power <= low + 4; power += step) {
      const double label = DrawnWidth(fmt::format("1e{}", power), size);
      const double x = (power - low) / 4.0 * width;
      const double begin = power == low ? x : power == low + 4 ? x - label : x - label / 2;
      apart = apart && begin >= end + size / 2;
      end = begin + label;
    }
    if (apart) return step;
  }
  return 4;
}

// The scale below the third cell, or `below` the measures: a bar with a tick at each power of ten.
void DrawScale(const SheetPage& page, const HeatScale& scale, bool below, bool light_ground,
               Canvas* canvas) {
  const double em = page.text_px;
  const double inset = StripInset(page);
  const int left = static_cast<int>(page.left + (below ? 0 : 2) * page.cell + inset);
  const int width = static_cast<int>((below ? 3 : 1) * page.cell - 2 * inset);
  const int height = std::max(static_cast<int>(0.6 * em), 2);
  const int top = static_cast<int>(page.strip_top + (below ? 3 * kMeasureLine + 0.5 : 0) * em);
  canvas->Paste(HeatLegend(width, height), left, top);
  const int low = static_cast<int>(std::lround(std::log10(scale.low)));
  const int step = LabelStep(low, width, kScaleText * em);
  for (int power = low; power <= low + 4; power += step) {
    const double x = left + (power - low) / 4.0 * width;
    const AlignX align = power == low       ? AlignX::kLeft
                         : power == low + 4 ? AlignX::kRight
                                            : AlignX::kCenter;
    canvas->AddText(PlainText(fmt::format("1e{}", power), x, top + height + 0.35 * em,
                              kScaleText * em, align, InkColor(light_ground)));
  }
  canvas->AddText(PlainText(kScaleCaption, below ? left : left + width / 2.0,
                            top + height + 1.6 * em, kScaleText * em,
                            below ? AlignX::kLeft : AlignX::kCenter, FaintInkColor(light_ground)));
}

void WriteMeasures(const SheetPage& page, const DifferenceMeasures& m, bool light_ground,
                   Canvas* canvas) {
  const double em = page.text_px;
  const double x = page.left + StripInset(page);
  const std::string lines[] = {fmt::format("RMSE {:.4g}", m.rmse),
                               fmt::format("largest {:.4g}", m.max),
                               fmt::format("mean of A - B {:+.4g}", m.mean)};
  double y = page.strip_top;
  for (const std::string& line : lines) {
    canvas->AddText(PlainText(line, x, y, em, AlignX::kLeft, InkColor(light_ground)));
    y += kMeasureLine * em;
  }
}

}  // namespace

void RefuseWhatNoDifferencePageTakes(const CLI::App& command, const std::string& what) {
  // The page is a PNG composed of two whole pictures, which have no file, plan or header of their
  // own.
  static const std::set<std::string> kRefused = {"--region",  "--tile",        "--layers",
                                                 "--depth",   "--compression", "--dry-run",
                                                 "--explain", "--stats",       "--progress"};
  RefuseOptions(
      command, [](const CLI::Option& option) { return !kRefused.contains(option.get_name()); },
      what, "nacre render and the other layouts of nacre pair take it");
}

Json DifferenceMeasures::ToJson() const { return {{"rmse", rmse}, {"max", max}, {"mean", mean}}; }

DifferenceMeasures DrawDifference(const DifferencePage& difference, const SheetOptions& sheet,
                                  const RenderOptions& options, const std::string& command,
                                  const std::vector<std::string>& outputs) {
  for (const std::string& path : options.outputs) CheckPngPath(path);
  CheckPathsDiffer(outputs);
  CheckOutputsAreNoInputs(outputs, InputFiles(sheet.lighting));
  ApplyTarget(options.target);
  const Lighting lighting = MakeLighting(sheet.lighting, 0.5);
  SheetRequest request = MakeSheetRequest(sheet, options, lighting, 1, 3);
  request.strip = kStrip;
  SheetText text;
  if (options.labels) {
    text.title = difference.title;
    text.column_labels = {"A: " + difference.a_label, "B: " + difference.b_label, "|A - B|"};
    text.footer = difference.footer;
  }
  SheetPage page = LayOutSheet(text, request);
  const bool scale_below = IsTooNarrow(page);
  if (scale_below) {
    request.strip = kTallStrip;
    page = LayOutSheet(text, request);
  }
  const int side = static_cast<int>(std::max(page.cell, 1.0));
  const Image a = RenderPanel(difference.a, side, sheet, options, lighting, command, outputs);
  const Image b = RenderPanel(difference.b, side, sheet, options, lighting, command, outputs);
  const DifferenceMeasures measures = Measure(a, b);
  if (options.outputs.empty()) return measures;

  const Rgb8Picture shown_a = ShowImage(a, options.display);
  const Rgb8 ground = {shown_a.rgb8[0], shown_a.rgb8[1], shown_a.rgb8[2]};
  Canvas canvas(page.width, page.height, ground);
  const int top = static_cast<int>(page.top);
  const auto left = [&](int i) { return static_cast<int>(page.left) + i * side; };
  canvas.Paste(shown_a, left(0), top);
  canvas.Paste(ShowImage(b, options.display), left(1), top);
  const HeatScale scale = ScaleFor(measures.max);
  canvas.Paste(ShowDifference(a, b, scale, ground, side), left(2), top);
  if (page.text_px > 0) {
    DrawScale(page, scale, scale_below, request.light_ground, &canvas);
    WriteMeasures(page, measures, request.light_ground, &canvas);
  }
  canvas.AddText(page.text);
  const Rgb8Picture& picture = canvas.Draw();
  for (const std::string& path : options.outputs) WritePng(path, picture, {.small = options.small});
  return measures;
}

}  // namespace nacre
