// SPDX-License-Identifier: Apache-2.0
#include "cli/report_inputs.h"

#include <chrono>
#include <filesystem>

#include "base/path.h"
#include "base/seconds_since.h"
#include "cli/outputs.h"
#include "cli/print.h"
#include "cli/progress.h"
#include "cli/stats_json.h"
#include "image_io/color_channels.h"
#include "image_io/read_image.h"
#include "output/metadata.h"
#include "render/render.h"
#include "scene_io/text_file.h"

namespace nacre {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr uint64_t kMaxJsonBytes = uint64_t{1} << 30;  // as for scenes

// The path without its folder, which a page that is passed on should not reveal.
std::string NameOf(const std::string& path) { return fs::path(path).filename().string(); }

// Sets the channel types of the image to halves where files of renders have them by default.
void TakeFileTypes(const FramePlan& plan, Image* image) {
  for (const ChannelSpec& spec : StripChannels(plan.film.layers, PixelType::kHalf)) {
    for (Channel& channel : image->channels) {
      if (channel.name == spec.name) channel.type = spec.type;
    }
  }
}

}  // namespace

Json ReadJson(const std::string& path) {
  FaultList faults;
  Json json = ParseJson(ReadTextFile(path, kMaxJsonBytes), path, &faults);
  ThrowFaults(faults, path);
  return json;
}

ReportInput KindOfInput(const std::string& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) return ReportInput::kReferences;
  if (IsModelFile(path)) return ReportInput::kScene;
  if (!HasExtension(path, ".json")) return ReportInput::kImage;
  const Json json = ReadJson(path);
  if (json.is_object() && json.contains("benchmarks") && json.contains("machine")) {
    return ReportInput::kBench;
  }
  if (json.is_object() && json.contains("time_ms") && json.contains("plan")) {
    return ReportInput::kStats;
  }
  return ReportInput::kScene;
}

ReportPicture ReadPicture(const std::string& path, const std::string& part) {
  Image image = ReadImage(path, part);
  const std::string note = ConvertImage(&image);  // pages show pictures in sRGB
  if (!note.empty()) PrintError("warning: {}: {}\n", path, note);
  return {NameOf(path), std::move(image), std::nullopt};
}

ReportPicture RenderPicture(const std::string& path, const RenderOptions& options,
                            const std::string& output) {
  const Clock::time_point start = Clock::now();
  JobTimes times;
  LoadOptions load = MakeLoadOptions(options);
  std::vector<std::string> read;
  load.on_file = [&](const fs::path& file) { read.push_back(file.string()); };
  const Scene scene = LoadScene(path, load);
  CheckOutputsAreNoInputs({output}, read);
  times.load_seconds = SecondsSince(start);
  RenderSettings settings = MakeRenderSettings(options);
  settings.time_stages = true;
  settings.on_progress = [](double) { ThrowIfStopped(); };
  const Clock::time_point plan_start = Clock::now();
  const FramePlan plan = MakePlan(scene, settings);
  const double plan_seconds = SecondsSince(plan_start);
  ReportPicture picture;
  picture.name = NameOf(path);
  RenderStats stats;
  picture.image = RenderImage(plan, settings, &stats);
  stats.plan_seconds = plan_seconds;
  times.total_seconds = SecondsSince(start);
  TakeFileTypes(plan, &picture.image);
  AddMetadata(MakeExrHeader(plan, /*reproducible=*/true), &picture.image);
  picture.stats = Json::parse(StatsJson(plan, stats, times, {}));
  picture.stats->erase("samples_not_as_computed");  // no file was written
  return picture;
}

}  // namespace nacre
