// SPDX-License-Identifier: Apache-2.0
// cli/cmd_tonemap.cc: nacre tonemap: converts a linear image to a PNG for a display.
#include <array>
#include <atomic>
#include <cstdlib>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "base/error.h"
#include "cli/commands.h"
#include "cli/outputs.h"
#include "cli/print.h"
#include "cli/render_options.h"
#include "image_io/color_channels.h"
#include "image_io/png_writer.h"
#include "image_io/read_image.h"
#include "scene/limits.h"

namespace nacre {
namespace {

struct TonemapArguments {
  std::string input, output;
  std::string layer, part;
  DisplaySettings display;
  std::string target = "auto";
  bool small = false;
};

// The channels of the requested layer. For the beauty of a multi-part file, those of the first part
// with colours.
ColorChannels RequireColors(const ImageFile& image, const TonemapArguments& arguments) {
  const std::string layer = arguments.layer == "beauty" ? "" : arguments.layer;
  const std::vector<Channel>& channels = image.header.channels;
  if (image.has_several && layer.empty()) {
    for (const ImagePart& part : image.parts) {
      const std::optional<ColorChannels> colors = FindColors(channels, part.name);
      if (!colors) continue;
      PrintError("warning: {}: shows part \"{}\" of {}; --part chooses another\n", image.path,
                 part.name, image.parts.size());
      return *colors;
    }
  } else if (const std::optional<ColorChannels> colors = FindColors(channels, layer)) {
    return *colors;
  }
  std::vector<std::string> names;
  for (const Channel& channel : channels) {
    names.push_back(channel.name.substr(0, channel.name.rfind('.')));
  }
  const std::string nearest = NearestName(layer, names);
  throw Error(ExitCode::kBadInput, image.path,
              layer.empty() ? "there are no channels R, G and B, nor one alone"
                            : "there is no layer \"" + layer + "\" of colours",
              nearest.empty() ? "--layer chooses one; " + TellChannels(channels)
                              : "did you mean \"" + nearest + "\"? nacre info lists the channels");
}

// The samples of the display window, black where the file has none.
struct ShownPixels {
  Window window;
  std::array<std::vector<float>, 3> rgb;  // only the first for a grey image

  const float* From(size_t c, size_t first) const {
    return rgb[rgb[c].empty() ? 0 : c].data() + first;
  }
};

ShownPixels ReadShown(const ImageFile& image, const ColorChannels& colors) {
  ShownPixels shown;
  shown.window = image.header.display;
  const int64_t width = int64_t{shown.window.x1} - shown.window.x0;
  const int64_t height = int64_t{shown.window.y1} - shown.window.y0;
  const auto largest = static_cast<int64_t>(limits::kImageSide.max);
  if (width < 1 || height < 1 || width > largest || height > largest) {
    throw Error(ExitCode::kBadInput, image.path,
                fmt::format("its display window has {} x {} pixels", width, height),
                "a PNG has 1 to 65536 a side");
  }
  const std::array<size_t, 3> channels = {colors.r, colors.g, colors.b};
  const size_t count = colors.is_grey() ? 1 : 3;
  image.CheckSize(shown.window, count);
  const Window common = Intersect(shown.window, image.header.data);
  std::vector<SampleTarget> targets;
  for (size_t c = 0; c < count; ++c) {
    shown.rgb[c].resize(shown.window.pixel_count());
    if (common.empty()) continue;
    targets.push_back({channels[c],
                       shown.rgb[c].data() + IndexIn(shown.window, common.x0, common.y0), 1,
                       shown.window.width()});
  }
  if (!common.empty()) image.read(common, targets);
  if (colors.is_grey()) return shown;
  const ColorConversion conversion = ConversionToRec709(image.header.metadata);
  if (!conversion.note.empty()) PrintError("warning: {}: {}\n", image.path, conversion.note);
  if (conversion.matrix) {
    const size_t outside = ConvertColors(
        *conversion.matrix, {shown.rgb[0].data(), shown.rgb[1].data(), shown.rgb[2].data()}, 1,
        shown.window.pixel_count(), /*clip=*/false);
    if (outside > 0) PrintError("warning: {}: {}\n", image.path, OutsideNote(outside));
  }
  return shown;
}

void RunTonemap(const TonemapArguments& arguments) {
  // The size is known only after reading, but an unwritable path is reported before that.
  CheckPngPath(arguments.output);
  CheckPathsDiffer({arguments.input, arguments.output});
  const ImageFile image = OpenImage(arguments.input, arguments.part);
  if (image.header.metadata.at("transfer") == "display") {
    throw Error(ExitCode::kBadInput, arguments.input, "the image is display-referred already",
                "give a linear image: EXR or HDR");
  }
  const ColorChannels colors = RequireColors(image, arguments);
  const ShownPixels shown = ReadShown(image, colors);
  const auto& metadata = image.parts.front().metadata;
  const auto aspect = metadata.find("pixelAspectRatio");
  if (aspect != metadata.end() && std::strtod(aspect->second.c_str(), nullptr) != 1) {
    PrintError(
        fmt::format("warning: {}: its pixels are {} times as wide as high, and are shown as "
                    "squares\n",
                    arguments.input, aspect->second));
  }
  const auto target = metadata.find("nacre:target");
  ApplyTargetOf(arguments.target, target != metadata.end() ? target->second : "");
  PngHeader header;
  header.width = shown.window.width();
  header.height = shown.window.height();
  header.text = {{"Software", "nacre"},
                 {"nacre:tonemap", ToneOperatorName(arguments.display.tone)}};
  PngWriter png(arguments.output, header, {.small = arguments.small});
  std::atomic<size_t> nan_pixels{0};
  png.WriteAll([&](size_t first, size_t count, uint8_t* rgb8) {
    nan_pixels += EncodeDisplay(arguments.display, shown.From(0, first), shown.From(1, first),
                                shown.From(2, first), count, rgb8);
  });
  png.Finish();
  if (nan_pixels > 0) {
    PrintError("warning: {} pixels are not numbers and are drawn in magenta\n", nan_pixels.load());
  }
}

}  // namespace

void AddTonemapCommand(CLI::App* app, int*) {
  CLI::App* command = app->add_subcommand("tonemap", "Tone-map a linear image (EXR, HDR) to PNG");
  const auto arguments = std::make_shared<TonemapArguments>();
  command->add_option("INPUT", arguments->input, "Linear image: EXR, HDR, ...")->required();
  command->add_option("-o,--output", arguments->output, "PNG file to write")->required();
  command->add_option("--layer", arguments->layer,
                      "Layer to show instead of the beauty, e.g. diffuse");
  command->add_option("--part", arguments->part, "Part of an EXR file that has several");
  AddDisplayOptions(command, &arguments->display);
  AddTargetOption(command, &arguments->target)
      ->description("SIMD target; auto: the one that nacre rendered the input on, if it did");
  command->add_flag("--small", arguments->small, "Smaller file, several times slower to write");
  command->footer(
      "Example:\n"
      "  nacre tonemap render.exr -o render.png --tonemap agx --exposure 0.5");
  command->callback([arguments] { RunTonemap(*arguments); });
}

}  // namespace nacre
