// SPDX-License-Identifier: Apache-2.0
// cli/cmd_compare.cc: nacre compare: metrics of an image against a reference, a verdict, a map.
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "base/error.h"
#include "cli/commands.h"
#include "cli/help_text.h"
#include "cli/metrics_json.h"
#include "cli/outputs.h"
#include "cli/perceptual_options.h"
#include "cli/print.h"
#include "cli/render_options.h"
#include "compare/heat_map.h"
#include "compare/perceptual.h"
#include "compare/verdict.h"
#include "image_io/canvas.h"
#include "image_io/png_writer.h"
#include "image_io/read_image.h"
#include "scene_io/json_text.h"

namespace nacre {
namespace {

struct CompareArguments {
  std::string image, reference, part;
  CompareOptions options;
  Tolerances tolerances;
  std::string heat_map;
  std::string heat_layer;
  HeatScale heat_scale;
  PerceptualArguments perceptual;
  bool absolute = false;
  bool json = false;
};

void PrintTable(const Verdict& verdict) {
  PrintOut("{:<14} {:>11} {:>11} {:>8} {:>11} {:>11} {:>11}  at\n", "layer", "RMSE", "relMSE",
           "PSNR dB", "max abs", "max rel", "99.9% rel");
  for (const LayerMetrics& m : verdict.layers) {
    PrintOut("{:<14} {:>11.4g} {:>11.4g} {:>8.2f} {:>11.4g} {:>11.4g} {:>11.4g}  {},{} {}\n",
             LayerName(m.layer), m.rmse, m.rel_mse, m.psnr_db, m.max_abs, m.max_rel, m.p999_rel,
             m.max_abs_at.x, m.max_abs_at.y, m.max_abs_at.channel);
    if (m.zero_mismatches > 0) {
      PrintOut("{:<14} {} samples are 0 in the reference only, and have no relative error\n", "",
               m.zero_mismatches);
    }
    if (m.nonfinite_mismatches > 0) {
      PrintOut("{:<14} {} samples are not finite in one image only\n", "", m.nonfinite_mismatches);
    }
  }
}

void PrintPerceptual(const std::vector<PerceptualMetrics>& all) {
  const auto figure = [](const std::optional<double>& value) {
    return value ? fmt::format("{:.6f}", *value) : std::string("-");
  };
  PrintOut("{:<14} {:>11} {:>11} {:>11} {:>13} {:>13}  exposures\n", "layer", "SSIM", "FLIP mean",
           "FLIP max", "HDR-FLIP mean", "HDR-FLIP max");
  for (const PerceptualMetrics& m : all) {
    const ExposureRange& range = m.exposures;
    PrintOut("{:<14} {:>11} {:>11} {:>11} {:>13} {:>13}  {}\n", LayerName(m.layer), figure(m.ssim),
             figure(m.flip_mean), figure(m.flip_max), figure(m.hdr_flip_mean),
             figure(m.hdr_flip_max),
             m.hdr_flip_mean
                 ? fmt::format("{} from {:.2f} to {:.2f}", range.count, range.start, range.stop)
                 : "-");
    for (const std::string& note : m.notes) PrintOut("{:<14} {}\n", "", note);
  }
}

// Describes how the data windows of parts with the same name differ, which the windows around all
// parts need not show; "" if they do not differ.
std::string PartWindowsInWords(const ImageFile& image, const ImageFile& reference) {
  if (!image.has_several) return {};
  for (const ImagePart& a : image.parts) {
    for (const ImagePart& b : reference.parts) {
      if (a.name != b.name || a.data == b.data) continue;
      return fmt::format("the data window of part \"{}\" is {}x{} at {},{}, not {}x{} at {},{}",
                         a.name, a.data.width(), a.data.height(), a.data.x0, a.data.y0,
                         b.data.width(), b.data.height(), b.data.x0, b.data.y0);
    }
  }
  return {};
}

// ---- The heat map -------------------------------------------------------------------------------

constexpr int kTextPx = 13;
constexpr int kBarHeight = 12;
constexpr int kLegendHeight = 60;
constexpr int kMargin = 24;
constexpr int kMinWidth = 320;  // so that the text of the legend fits

constexpr Rgb8 kGround = {24, 24, 24};

TextItem LegendText(const std::string& text, int x, int y) {
  return {.text = text, .x = x, .y = y, .size_px = kTextPx, .align_x = AlignX::kCenter};
}

void DrawLegend(int top, int width, HeatQuantity quantity, const HeatScale& scale, Canvas* page) {
  page->Paste(HeatLegend(width, kBarHeight), kMargin, top);
  const int low = static_cast<int>(std::ceil(std::log10(scale.low) - 1e-9));
  const int high = static_cast<int>(std::floor(std::log10(scale.high) + 1e-9));
  for (int power = low; power <= high; ++power) {
    const int x = kMargin + static_cast<int>(scale.Position(std::pow(10.0, power)) * width);
    page->AddText(LegendText(fmt::format("1e{}", power), x, top + kBarHeight + 3));
  }
  page->AddText(LegendText(quantity == HeatQuantity::kRelative
                               ? "error / sqrt(reference^2 + 0.01^2), black: equal"
                               : "absolute error, black: equal",
                           width / 2 + kMargin, top + kBarHeight + 5 + kTextPx));
}

// Writes the map, and below it a bar of its colours with ticks at powers of ten.
void WriteHeatPicture(const std::string& path, const Rgb8Picture& map, HeatQuantity quantity,
                      const HeatScale& scale) {
  const int width = std::max(map.width, kMinWidth);
  Canvas page(width, map.height + kLegendHeight, kGround);
  page.Paste(map, 0, 0);
  DrawLegend(map.height + 8, width - 2 * kMargin, quantity, scale, &page);
  WritePng(path, page.Draw());
}

// ---- The command --------------------------------------------------------------------------------

int RunCompare(const CompareArguments& arguments) {
  const HeatScale& scale = arguments.heat_scale;
  if (!(scale.low < scale.high)) {
    throw Error(ExitCode::kUsage, "--heat-low",
                fmt::format("{} is not below --heat-high, {}", scale.low, scale.high),
                "the scale goes from its dark end up to its bright end");
  }
  if (!arguments.heat_map.empty()) {
    CheckPngPath(arguments.heat_map);
    CheckPathsDiffer({arguments.image, arguments.heat_map});
    CheckPathsDiffer({arguments.reference, arguments.heat_map});
  }
  const std::optional<PerceptualOptions> perceptual = MakePerceptualOptions(arguments.perceptual);
  const ImageFile image_file = OpenImage(arguments.image, arguments.part);
  const ImageFile reference_file = OpenImage(arguments.reference, arguments.part);
  const Image image = ReadImage(image_file);
  const Image reference = ReadImage(reference_file);
  CompareOptions options = arguments.options;
  options.sizes_may_differ = true;
  options.got_name = arguments.image;
  options.reference_name = arguments.reference;
  for (std::string& layer : options.layers) layer = LayerOfName(layer);
  Verdict verdict = Judge(image, reference, arguments.tolerances, options);
  const std::string parts = PartWindowsInWords(image_file, reference_file);
  if (verdict.match && !parts.empty() && !options.crop) {
    verdict.match = false;
    verdict.reason = parts + "; the pixels that both have match";
  }
  std::vector<PerceptualMetrics> seen;
  if (perceptual) seen = MeasurePerceptual(image, reference, *perceptual, options);
  if (arguments.json) {
    PrintOut(JsonText(VerdictJson(verdict, seen), 2) + "\n");
  } else {
    PrintTable(verdict);
    if (!seen.empty()) PrintPerceptual(seen);
    PrintOut("{}: {}\n", verdict.match ? "match" : "differ", verdict.reason);
  }
  if (!arguments.heat_map.empty()) {
    const HeatQuantity quantity =
        arguments.absolute ? HeatQuantity::kAbsolute : HeatQuantity::kRelative;
    WriteHeatPicture(arguments.heat_map,
                     HeatMap(image, reference, LayerOfName(arguments.heat_layer), quantity, scale),
                     quantity, scale);
  }
  return static_cast<int>(verdict.match ? ExitCode::kOk : ExitCode::kDiffers);
}

}  // namespace

void AddCompareCommand(CLI::App* app, int* exit_code) {
  CLI::App* command = app->add_subcommand(
      "compare", "Compare an image with a reference: metrics per layer, verdict, heat map");
  const auto a = std::make_shared<CompareArguments>();
  command->add_option("IMAGE", a->image, "Image to judge")->required();
  command->add_option("REFERENCE", a->reference, "Image to compare it with")->required();
  command
      ->add_option("--layers", a->options.layers,
                   "Layers to compare, e.g. beauty,diffuse; if not given all, which must then be "
                   "the same in both images")
      ->delimiter(',')
      ->allow_extra_args(false);
  command->add_option("--part", a->part, "Part of EXR files that have several");
  command->add_flag("--crop", a->options.crop,
                    "Compare only the pixels that both images have; if not given, display windows "
                    "that differ are a difference");
  const auto not_negative = InRange(0, 1e30);
  {
    const InGroup group(command, "Tolerances (without any, images must be equal)");
    command
        ->add_option("--max-abs", a->tolerances.max_abs,
                     "A sample may differ by this plus --max-rel times |reference|")
        ->check(not_negative);
    command
        ->add_option("--max-rel", a->tolerances.max_rel,
                     "Relative tolerance, added to --max-abs; with --max-abs 0, samples whose "
                     "reference is 0 must be equal")
        ->check(not_negative);
    command
        ->add_option("--fraction", a->tolerances.exceeding_fraction,
                     "Share of the pixels that may exceed these two")
        ->check(InRange(0, 1));
    command
        ->add_option("--rmse", a->tolerances.rmse,
                     "Allowed RMSE of a layer; if it is the only tolerance, single samples may "
                     "differ by any amount")
        ->check(not_negative);
  }
  AddPerceptualOptions(command, &a->perceptual);
  {
    const InGroup group(command, "Heat map");
    command->add_option("--heat-map", a->heat_map, "PNG file that shows the error of each pixel");
    command->add_option("--heat-layer", a->heat_layer, "Layer to show (the beauty, if not given)");
    command->add_option("--heat-low", a->heat_scale.low, "Error at the dark end of the scale")
        ->check(InRange(1e-30, 1e30))
        ->capture_default_str();
    command->add_option("--heat-high", a->heat_scale.high, "Error at the bright end of the scale")
        ->check(InRange(1e-30, 1e30))
        ->capture_default_str();
    command->add_flag("--absolute", a->absolute,
                      "Show absolute errors, not errors relative to sqrt(reference^2 + 0.01^2)");
  }
  command->add_flag("--json", a->json, "Print the result as JSON");
  MoveBehindHelpAll(command, {"--part", "--crop", "--fraction", "--heat-layer", "--heat-low",
                              "--heat-high", "--absolute"});
  command->footer(
      "Exit code: 0 they match, 1 they differ, 2 they cannot be compared.\n"
      "Examples:\n"
      "  nacre compare render.exr reference.exr --max-rel 1e-3 --heat-map error.png\n"
      "  nacre compare render.exr reference.exr --metrics all --ppd 40");
  command->callback([a, exit_code] {
    try {
      *exit_code = RunCompare(*a);
    } catch (const Error& error) {
      // An image that cannot be read cannot be compared, so the exit code is another one.
      if (error.code() != ExitCode::kBadInput) throw;
      throw Error(ExitCode::kCannotCompare, error.faults());
    }
  });
}

}  // namespace nacre
