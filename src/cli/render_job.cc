// SPDX-License-Identifier: Apache-2.0
#include "cli/render_job.h"

#include <chrono>

#include <fmt/format.h>

#include "base/seconds_since.h"
#include "cli/outputs.h"
#include "cli/print.h"
#include "cli/progress.h"
#include "cli/stats_json.h"
#include "cli/text_output.h"
#include "render/frame_window.h"
#include "render/render.h"

namespace nacre {
namespace {

using Clock = std::chrono::steady_clock;

ProgressForm ChooseProgressForm(const RenderOptions& options) {
  if (options.quiet || options.progress == "none") return ProgressForm::kNone;
  if (options.progress == "bar") return ProgressForm::kBar;
  if (options.progress == "json") return ProgressForm::kJson;
  return DefaultProgressForm();
}

// Of what comes before the rendering, for people: programs are told how far the rendering is.
ProgressForm EarlyProgressForm(const RenderOptions& options) {
  const ProgressForm form = ChooseProgressForm(options);
  return form == ProgressForm::kJson ? ProgressForm::kNone : form;
}

// What the user must know of samples that are not as computed.
void WarnAboutSamples(const OutputCounts& counts, const RenderStats& stats) {
  if (stats.directions_not_finite > 0) {
    PrintError("warning: {} sampled directions to light are not numbers and brought none\n",
               stats.directions_not_finite);
  }
  if (counts.exr.clamped > 0) {
    PrintError("warning: {} samples beyond +-65504 were clamped; --depth float keeps them\n",
               counts.exr.clamped);
  }
  if (counts.exr.infinite > 0) {
    PrintError("warning: {} samples are infinite\n", counts.exr.infinite);
  }
  if (counts.exr.nan > 0) PrintError("warning: {} samples are not numbers\n", counts.exr.nan);
  if (counts.nan_pixels > 0) {
    PrintError("warning: {} pixels are not numbers and are drawn in magenta\n", counts.nan_pixels);
  }
}

void Summarize(const RenderOptions& options, const FramePlan& plan, const RenderStats& stats,
               const JobTimes& times) {
  std::string files;
  for (const std::string& path : FilesAmong(options.outputs)) {
    files += (files.empty() ? "" : ", ") + path;
  }
  if (files.empty()) files = "no file";
  const PixelSampleCounts& counts = stats.pixel_samples;
  const std::string samples =
      plan.adaptive.max_error > 0
          ? fmt::format("{} to {} samples a pixel, {:.1f} on average", counts.fewest, counts.most,
                        counts.Mean())
          : fmt::format("{} sample{} a pixel", counts.most, counts.most == 1 ? "" : "s");
  PrintError(
      "{}: {}x{}, {}, {:.0f} ms ({:.0f} ms rendering, {:.1f} M rays/s)\n", files,
      plan.window.width(), plan.window.height(), samples, 1e3 * times.total_seconds,
      1e3 * stats.render_seconds,
      1e-6 * static_cast<double>(stats.camera_rays + stats.shadow_rays) / stats.render_seconds);
}

}  // namespace

void RunRenderJob(const RenderOptions& options, const std::vector<std::string>& inputs,
                  const std::function<Scene(const LoadOptions&)>& load,
                  const std::vector<TextItem>& captions) {
  const Clock::time_point start = Clock::now();
  JobTimes times;
  LoadOptions load_options = MakeLoadOptions(options);
  RenderSettings settings = MakeRenderSettings(options);
  ApplyTarget(options.target);
  std::vector<std::string> paths = FilesAmong(options.outputs);
  CheckPicturePaths(paths);
  if (!options.stats.empty()) {
    CheckTextOutput(options.stats);
    if (options.stats != "-") paths.push_back(options.stats);
  }
  CheckPathsDiffer(paths);
  CheckOutputsAreNoInputs(paths, inputs);

  std::vector<std::string> warnings;
  std::vector<std::string> read;  // files that the scene refers to
  const Scene scene = [&] {
    Progress progress(EarlyProgressForm(options), "reading", 0, "");
    load_options.on_warning = [&](const std::string& text) {
      if (!options.quiet) warnings.push_back(text);
    };
    load_options.on_file = [&](const std::filesystem::path& file) {
      read.push_back(file.string());
    };
    load_options.on_progress = [&](double done) { progress.Update(done); };
    return load(load_options);
  }();
  CheckOutputsAreNoInputs(paths, read);
  for (const std::string& text : warnings) PrintError("warning: {}\n", text);
  times.load_seconds = SecondsSince(start);
  ThrowIfStopped();

  const Clock::time_point plan_start = Clock::now();
  const FramePlan plan = [&] {
    Progress progress(EarlyProgressForm(options), "planning", 0, "");
    settings.on_plan_progress = [&](double done) { progress.Update(done); };
    return MakePlan(scene, settings);
  }();
  const double plan_seconds = SecondsSince(plan_start);
  // Only now: an option that is wrong in itself has been refused, once.
  for (const IdleOption& idle : options.idle_options) {
    if (options.quiet) break;
    PrintError("warning: {} changes nothing: it is for {} files, and none is written\n", idle.name,
               idle.extension);
  }
  if (options.dry_run) {
    PrintOut(DryRunJson(MakeOutputHeader(options, plan), options,
                        MaxBands(plan.frame, settings.band_rows)));
    return;
  }
  Outputs outputs(options, plan, captions);
  RenderStats stats;
  {
    const double samples = static_cast<double>(plan.window.pixel_count()) * scene.image.spp;
    Progress progress(ChooseProgressForm(options), "rendering", samples, "samples");
    settings.on_progress = [&](double done) { progress.Update(done); };
    stats = Render(plan, settings, [&](const Strip& strip) { outputs.WriteStrip(strip); });
  }
  stats.plan_seconds = plan_seconds;
  ThrowIfStopped();
  const Clock::time_point finish_start = Clock::now();
  const OutputCounts counts = outputs.Finish(stats);
  times.finish_seconds = SecondsSince(finish_start);
  times.total_seconds = SecondsSince(start);

  if (!options.quiet) {
    for (const std::string& note : plan.why.notes) PrintError("note: {}\n", note);
  }
  if (!options.quiet && stats.unsettled_pixels > 0) {
    PrintError(
        "note: {} of {} pixels did not settle within {} samples; give more by --spp, or a larger "
        "--max-error\n",
        stats.unsettled_pixels, plan.window.pixel_count(), stats.pixel_samples.most);
  }
  WarnAboutSamples(counts, stats);
  if (!options.quiet && options.progress != "json") Summarize(options, plan, stats, times);
  if (options.explain) PrintOut(ExplainPlan(plan, &stats));
  if (!options.stats.empty()) WriteText(options.stats, StatsJson(plan, stats, times, counts));
}

}  // namespace nacre
