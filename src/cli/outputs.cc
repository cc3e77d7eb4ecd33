// SPDX-License-Identifier: Apache-2.0
#include "cli/outputs.h"

#include <filesystem>
#include <map>
#include <optional>
#include <system_error>

#include <fmt/format.h>

#include "base/error.h"
#include "base/path.h"
#include "cli/labels.h"
#include "image_io/output_file.h"
#include "output/metadata.h"

namespace nacre {
namespace {

bool IsExr(const std::string& path) { return HasExtension(path, ".exr"); }
bool IsPng(const std::string& path) { return HasExtension(path, ".png"); }

StripView ViewOf(const Strip& strip) {
  StripView view;
  view.y = strip.window.y0;
  view.rows = strip.window.height();
  for (const auto& plane : strip.colors) view.channels.emplace_back(plane.data());
  for (const auto& plane : strip.ids) view.channels.emplace_back(plane.data());
  return view;
}

}  // namespace

std::vector<std::string> FilesAmong(const std::vector<std::string>& outputs) {
  std::vector<std::string> files = outputs;
  std::erase(files, kNullOutput);
  return files;
}

void CheckPicturePaths(const std::vector<std::string>& paths) {
  for (const std::string& path : paths) {
    if (!IsExr(path) && !IsPng(path)) {
      throw Error(ExitCode::kUsage, path, "unknown output extension",
                  "nacre writes .exr (linear, HDR) and .png (tone-mapped)");
    }
    CheckWritable(path);
  }
}

void CheckPngPath(const std::string& path) {
  if (!IsPng(path)) {
    throw Error(ExitCode::kUsage, path, "unknown output extension", "the output is a .png file");
  }
  CheckWritable(path);
}

void CheckPathsDiffer(const std::vector<std::string>& paths) {
  std::map<std::string, std::string> seen;
  for (const std::string& path : paths) {
    const auto [first, is_new] = seen.emplace(FileIdentity(path), path);
    if (is_new) continue;
    throw Error(ExitCode::kUsage, path,
                "the same file is named twice" +
                    (first->second == path ? "" : fmt::format(", also as \"{}\"", first->second)),
                "an output must not replace another file of the same command");
  }
}

void CheckOutputsAreNoInputs(const std::vector<std::string>& outputs,
                             const std::vector<std::string>& inputs) {
  std::map<std::string, std::string> read;
  for (const std::string& input : inputs) {
    std::error_code unknown;
    if (std::filesystem::exists(input, unknown)) read.emplace(FileIdentity(input), input);
  }
  for (const std::string& output : outputs) {
    const auto found = read.find(FileIdentity(output));
    if (found == read.end()) continue;
    throw Error(ExitCode::kUsage, output,
                "is read for this picture" +
                    (found->second == output ? "" : fmt::format(", as \"{}\"", found->second)),
                "an output must not replace what it is made from: name another file");
  }
}

ExrHeader MakeOutputHeader(const RenderOptions& options, const FramePlan& plan,
                           PreparedScene* prepared) {
  const auto tile = options.setting_texts.find("tile");
  ExrHeader header =
      MakeExrHeader(plan, options.reproducible,
                    tile != options.setting_texts.end() ? tile->second : std::string(), prepared);
  const PixelType color_type = options.depth == "float" ? PixelType::kFloat : PixelType::kHalf;
  for (const ChannelSpec& channel : StripChannels(plan.film.layers, color_type)) {
    header.channels.push_back({channel.name, channel.type});
  }
  return header;
}

Outputs::Outputs(const RenderOptions& options, const FramePlan& plan, PreparedScene* prepared,
                 const std::vector<TextItem>& captions)
    : options_(options), plan_(plan), captions_(captions) {
  std::optional<ExrHeader> header;  // of EXR files, which alone hold the scene's hash
  const ExrOptions exr_options{.compression = ParseCompression(options.compression),
                               .small = options.small,
                               .reproducible = options.reproducible};
  PngHeader png_header;
  png_header.width = plan.window.width();
  png_header.height = plan.window.height();
  png_header.text = {{"Software", SoftwareName()},
                     {"nacre:shadowing", ShadowingForms(plan.surfaces.prepared->any)},
                     {"nacre:tonemap", ToneOperatorName(options.display.tone)}};
  for (const std::string& path : FilesAmong(options.outputs)) {
    if (IsExr(path)) {
      if (!header) header = MakeOutputHeader(options, plan, prepared);
      exr_.push_back(std::make_unique<ExrWriter>(path, *header, exr_options));
    } else {
      png_.push_back(std::make_unique<PngWriter>(
          path, png_header,
          PngOptions{.small = options.small, .reproducible = options.reproducible}));
    }
  }
  if (options.labels && !png_.empty()) picture_.resize(3 * plan.window.pixel_count());
}

void Outputs::WriteStrip(const Strip& strip) {
  const StripView view = ViewOf(strip);
  for (const auto& exr : exr_) exr->WriteStrip(view);
  if (!png_.empty()) WritePng(strip);
}

void Outputs::WritePng(const Strip& strip) {
  const size_t count = strip.window.pixel_count();
  const int row = strip.window.y0 - plan_.window.y0;
  std::vector<uint8_t> own(picture_.empty() ? 3 * count : 0);
  const size_t first = static_cast<size_t>(row) * static_cast<size_t>(plan_.window.width());
  uint8_t* const rgb8 = picture_.empty() ? own.data() : picture_.data() + 3 * first;
  nan_pixels_ += EncodeDisplay(options_.display, strip.colors[0].data(), strip.colors[1].data(),
                               strip.colors[2].data(), count, rgb8);
  if (!picture_.empty()) return;
  for (const auto& png : png_) png->WriteStrip(row, strip.window.height(), rgb8);
}

void Outputs::DrawTexts() {
  const Window& window = plan_.window;
  if (captions_.empty()) return DrawLabels(*plan_.scene, window, picture_);
  std::vector<TextItem> items = captions_;
  for (TextItem& item : items) {
    item.x -= window.x0;
    item.y -= window.y0;
  }
  DrawText(picture_, window.width(), window.height(), items);
}

OutputCounts Outputs::Finish(const RenderStats& stats) {
  if (!picture_.empty()) {
    DrawTexts();
    for (const auto& png : png_) png->WriteAll(picture_);
  }
  OutputCounts counts;
  counts.nan_pixels = nan_pixels_;
  for (const auto& exr : exr_) {
    if (!options_.reproducible) {
      exr->UpdateAttribute(kRenderTimeAttribute, static_cast<float>(stats.render_seconds));
    }
    exr->Finish();
    counts.exr += exr->counts();
  }
  for (const auto& png : png_) png->Finish();
  return counts;
}

}  // namespace nacre
