// SPDX-License-Identifier: Apache-2.0
// cli/cmd_tonemap.cc: nacre tonemap: a linear image to a PNG for a display.
#include <algorithm>
#include <atomic>
#include <memory>

#include <fmt/format.h>

#include "base/error.h"
#include "base/parallel.h"
#include "cli/commands.h"
#include "cli/outputs.h"
#include "cli/print.h"
#include "cli/render_options.h"
#include "image_io/image_reader.h"
#include "image_io/output_file.h"
#include "image_io/png_writer.h"

namespace nacre {
namespace {

struct TonemapArguments {
  std::string input, output;
  std::string layer;
  std::string tonemap = "neutral";
  double exposure = 0;
  bool small = false;
};

const Channel& RequireChannel(const Image& image, const std::string& path,
                              const std::string& name) {
  const Channel* channel = image.Find(name);
  if (channel != nullptr) return *channel;
  std::vector<std::string> names;
  for (const Channel& known : image.channels) names.push_back(known.name);
  const std::string nearest = NearestName(name, names);
  throw Error(ExitCode::kBadInput, path, "there is no channel \"" + name + "\"",
              nearest.empty() ? "nacre info lists the channels"
                              : "did you mean \"" + nearest + "\"? nacre info lists them");
}

void RunTonemap(const TonemapArguments& arguments) {
  // The size is known only after reading, but a path that cannot be written is told before.
  CheckPngPath(arguments.output);
  CheckPathsDiffer({arguments.input, arguments.output});
  const Image image = ReadImage(arguments.input);
  const auto transfer = image.metadata.find("transfer");
  if (transfer != image.metadata.end() && transfer->second == "display") {
    throw Error(ExitCode::kBadInput, arguments.input, "the image is display-referred already",
                "give a linear image: EXR or HDR");
  }
  const bool beauty = arguments.layer.empty() || arguments.layer == "beauty";
  const std::string prefix = beauty ? "" : arguments.layer + ".";
  const float* rgb[3] = {};
  for (size_t c = 0; c < 3; ++c) {
    rgb[c] = RequireChannel(image, arguments.input, prefix + "RGB"[c]).samples.data();
  }
  const DisplaySettings display{.tone = ParseToneOperator(arguments.tonemap),
                                .exposure_ev = arguments.exposure};
  const size_t width = static_cast<size_t>(image.data.width());
  PngHeader header;
  header.width = image.data.width();
  header.height = image.data.height();
  header.text = {{"Software", "nacre"}, {"nacre:tonemap", arguments.tonemap}};
  PngWriter png(arguments.output, header, {.small = arguments.small});
  const int strips = (header.height + PngWriter::kStripRows - 1) / PngWriter::kStripRows;
  std::atomic<size_t> nan_pixels{0};
  ParallelFor(static_cast<size_t>(strips), 0, [&](size_t strip) {
    const int y = static_cast<int>(strip) * PngWriter::kStripRows;
    const int rows = std::min(PngWriter::kStripRows, header.height - y);
    const size_t first = static_cast<size_t>(y) * width;
    const size_t count = static_cast<size_t>(rows) * width;
    std::vector<uint8_t> rgb8(3 * count);
    nan_pixels +=
        EncodeDisplay(display, rgb[0] + first, rgb[1] + first, rgb[2] + first, count, rgb8.data());
    png.WriteStrip(y, rows, rgb8.data());
  });
  png.Finish();
  if (nan_pixels > 0) {
    PrintError("warning: {} pixels are not numbers and are drawn in magenta\n", nan_pixels.load());
  }
}

}  // namespace

void AddTonemapCommand(CLI::App* app, int*) {
  CLI::App* command = app->add_subcommand("tonemap", "Tone-map a linear image (EXR) to a PNG");
  const auto arguments = std::make_shared<TonemapArguments>();
  command->add_option("INPUT", arguments->input, "Linear image: EXR, HDR, ...")->required();
  command->add_option("-o,--output", arguments->output, "PNG file to write")->required();
  command->add_option("--layer", arguments->layer,
                      "Layer to show instead of the beauty, e.g. diffuse");
  AddDisplayOptions(command, &arguments->tonemap, &arguments->exposure);
  command->add_flag("--small", arguments->small, "Smaller file, several times slower");
  command->footer(
      "Example:\n"
      "  nacre tonemap render.exr -o render.png --tonemap agx --exposure 0.5");
  command->callback([arguments] { RunTonemap(*arguments); });
}

}  // namespace nacre
