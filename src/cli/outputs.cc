// SPDX-License-Identifier: Apache-2.0
#include "cli/outputs.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <system_error>

#include <fmt/format.h>

#include "base/error.h"
#include "base/path.h"
#include "image_io/output_file.h"
#include "output/metadata.h"
#include "render/camera.h"

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

// The text size: legible at half resolution if there is room for that, but so small that labels of
// neighbouring columns do not touch.
int LabelSize(const Scene& scene, const Imath::M44d& ndc_from_world) {
  constexpr double kGlyphWidth = 0.52;  // mean width over letters and digits of DejaVu Sans, per
                                        // size
  double size = std::clamp(scene.image.height / 40.0, 10.0, 48.0);
  const Label* left = nullptr;
  for (const Label& label : scene.labels) {
    if (label.side == Label::Side::kLeft) continue;
    if (left != nullptr && left->side == label.side) {
      Vec3d a, b;
      ndc_from_world.multVecMatrix(left->anchor, a);
      ndc_from_world.multVecMatrix(label.anchor, b);
      const double spacing = std::abs(b.x - a.x) / 2 * scene.image.width;
      const double glyphs = static_cast<double>(left->text.size() + label.text.size()) / 2 + 1;
      size = std::min(size, spacing / (glyphs * kGlyphWidth));
    }
    left = &label;
  }
  constexpr double kSmallest = 5;
  return static_cast<int>(std::max(size, kSmallest));
}

// Whether two lines of the same size would touch.
bool Touch(const TextItem& a, const TextItem& b) {
  const auto begin = [](const TextItem& item, double width) {
    return item.x - (item.align_x == AlignX::kRight ? width : width / 2);
  };
  const double a_width = DrawnWidth(a.text, a.size_px), b_width = DrawnWidth(b.text, b.size_px);
  const double a_begin = begin(a, a_width), b_begin = begin(b, b_width);
  const double gap = a.size_px / 2.0;
  return std::abs(a.y - b.y) < a.size_px && a_begin < b_begin + b_width + gap &&
         b_begin < a_begin + a_width + gap;
}

// Draws each of the scene's labels beside the projection of its anchor (--labels), unless it would
// touch one drawn before. `rgb8` holds the pixels of `window` of the scene's frame.
void DrawLabels(const Scene& scene, const Window& window, std::span<uint8_t> rgb8) {
  const ImageSettings& image = scene.image;
  const Imath::M44d ndc_from_world = WorldToNdc(scene.camera, image.width, image.height);
  const Vec3d forward = scene.camera.look_at - scene.camera.position;
  const int size_px = LabelSize(scene, ndc_from_world);
  const int gap = size_px / 2;
  std::vector<TextItem> items;
  for (const Label& label : scene.labels) {
    // Anchors behind the camera are not in the picture.
    if (scene.camera.projection == Projection::kPerspective &&
        ((label.anchor - scene.camera.position) ^ forward) <= 0) {
      continue;
    }
    Vec3d ndc;
    ndc_from_world.multVecMatrix(label.anchor, ndc);
    constexpr double kFarOutside = 4;  // compared to [-1, 1]: no text reaches the picture from
                                       // there
    if (!(std::abs(ndc.x) < kFarOutside && std::abs(ndc.y) < kFarOutside)) continue;
    TextItem item;
    item.text = label.text;
    item.size_px = size_px;
    item.x = static_cast<int>((ndc.x + 1) / 2 * image.width) - window.x0;
    item.y = static_cast<int>((1 - ndc.y) / 2 * image.height) - window.y0;
    if (label.side == Label::Side::kLeft) {
      item.x -= 2 * gap;
      item.align_x = AlignX::kRight;
      item.align_y = AlignY::kCenter;
    } else {
      const bool above = label.side == Label::Side::kAbove;
      item.y += above ? -gap : gap;
      item.align_x = AlignX::kCenter;
      item.align_y = above ? AlignY::kBottom : AlignY::kTop;
    }
    const auto touches = [&](const TextItem& other) { return Touch(item, other); };
    if (std::any_of(items.begin(), items.end(), touches)) continue;
    items.push_back(item);
  }
  DrawText(rgb8, window.width(), window.height(), items);
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
