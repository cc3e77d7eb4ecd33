// SPDX-License-Identifier: Apache-2.0
#include "cli/render_job.h"

#include <exception>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/seconds_since.h"
#include "cli/outputs.h"
#include "cli/print.h"
#include "cli/progress.h"
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

// The progress form of work before the rendering. Programs are only told of the rendering.
ProgressForm EarlyProgressForm(const RenderOptions& options) {
  const ProgressForm form = ChooseProgressForm(options);
  return form == ProgressForm::kJson ? ProgressForm::kNone : form;
}

// Warns the user of samples that are not stored as computed.
void WarnAboutSamples(const OutputCounts& counts, const RenderStats& stats) {
  const auto warn = [](uint64_t count, const char* what) {
    if (count > 0) PrintError("warning: {} {}\n", count, what);
  };
  warn(stats.directions_not_finite, "sampled directions to light are not numbers and brought none");
  warn(counts.exr.clamped, "samples beyond +-65504 were clamped; --depth float keeps them");
  warn(counts.exr.infinite, "samples are infinite");
  warn(counts.exr.nan, "samples are not numbers");
  warn(counts.nan_pixels, "pixels are not numbers and are drawn in magenta");
}

// Warns before an adaptive render that will take long, or in which many pixels will not converge.
void TellForecast(const RenderOptions& options, const FramePlan& plan, const Forecast& forecast) {
  if (options.progress == "json") {
    return PrintError(
        "{{\"forecast\": {{\"samples_per_pixel\": {:.1f}, \"seconds\": {:.1f}, "
        "\"unsettled_share\": {:.4f}}}}}\n",
        forecast.samples_per_pixel, forecast.seconds, forecast.unsettled_share);
  }
  if (forecast.seconds < 10 && forecast.unsettled_share < 0.05) return;
  PrintError("note: about {:.0f} samples a pixel, {}", forecast.samples_per_pixel,
             FormatSeconds(forecast.seconds));
  if (forecast.unsettled_share < 0.01) return PrintError("\n");
  PrintError(
      "; about {:.0f} % of the pixels will not settle within {} samples: a smaller --spp ends them "
      "sooner, a larger --max-error settles more\n",
      100 * forecast.unsettled_share, plan.adaptive.max_samples);
}

void Summarize(const RenderOptions& options, const FramePlan& plan, const RenderStats& stats,
               const JobTimes& times) {
  std::string files = fmt::format("{}", fmt::join(FilesAmong(options.outputs), ", "));
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

RenderJob::RenderJob(const RenderOptions& options, const std::vector<std::string>& inputs)
    : options_(options),
      load_options_(MakeLoadOptions(options)),
      settings_(MakeRenderSettings(options)) {
  ApplyTarget(options.target);
  settings_.cancel = &CancelFlag();
  std::vector<std::string> paths = FilesAmong(options.outputs);
  CheckPicturePaths(paths);
  if (!options.stats.empty()) {
    CheckTextOutput(options.stats);
    if (options.stats != "-") paths.push_back(options.stats);
  }
  CheckPathsDiffer(paths);
  CheckOutputsAreNoInputs(paths, inputs);
  paths_ = std::move(paths);
  load_options_.on_warning = [this](const std::string& text) {
    if (!options_.quiet) warnings_.push_back(text);
  };
  load_options_.on_file = [this](const std::filesystem::path& file) {
    read_.insert(file.string());
  };
  load_options_.on_progress = [this](double done) { on_load_progress_(done); };
}

void RenderJob::Load(const std::function<void()>& load) {
  start_ = Clock::now();
  times_ = {};
  warnings_.clear();
  std::exception_ptr error;
  {
    Progress progress(EarlyProgressForm(options_), "reading", 0, "");
    on_load_progress_ = [&](double done) { progress.Update(done); };
    try {
      load();
    } catch (...) {
      error = std::current_exception();
    }
  }
  // Printed even before an error, which they may explain.
  for (const std::string& text : warnings_) PrintError("warning: {}\n", text);
  if (error) std::rethrow_exception(error);
  CheckOutputsAreNoInputs(paths_, {read_.begin(), read_.end()});
  times_.load_seconds = SecondsSince(start_);
  ThrowIfStopped();
}

void RenderJob::Render(const Scene& scene, PreparedScene* prepared,
                       const std::vector<TextItem>& captions) {
  const RenderOptions& options = options_;
  const Clock::time_point plan_start = Clock::now();
  const FramePlan plan = [&] {
    Progress progress(EarlyProgressForm(options), "planning", 0, "");
    settings_.on_plan_progress = [&](double done) { progress.Update(done); };
    return prepared != nullptr ? MakePlan(scene, settings_, prepared) : MakePlan(scene, settings_);
  }();
  const double plan_seconds = SecondsSince(plan_start);
  // Only now, because options that are invalid in themselves have been refused.
  for (const IdleOption& idle : options.idle_options) {
    if (options.quiet) break;
    PrintError("warning: {} changes nothing: it is for {} files, and none is written\n", idle.name,
               idle.extension);
  }
  if (options.dry_run) {
    PrintOut(DryRunJson(MakeOutputHeader(options, plan), options,
                        MaxBands(plan.frame, settings_.band_rows)));
    return;
  }
  times_.forecast = ForecastRender(plan, settings_);
  if (times_.forecast && !options.quiet) TellForecast(options, plan, *times_.forecast);
  Outputs outputs(options, plan, prepared, captions);
  RenderStats stats;
  {
    const double samples = static_cast<double>(plan.window.pixel_count()) * scene.image.spp;
    Progress progress(ChooseProgressForm(options), "rendering", samples, "samples");
    settings_.on_progress = [&](double done) { progress.Update(done); };
    stats = nacre::Render(plan, settings_, [&](const Strip& strip) { outputs.WriteStrip(strip); });
  }
  stats.plan_seconds = plan_seconds;
  ThrowIfStopped();
  const Clock::time_point finish_start = Clock::now();
  const OutputCounts counts = outputs.Finish(stats);
  times_.finish_seconds = SecondsSince(finish_start);
  times_.total_seconds = SecondsSince(start_);

  if (!options.quiet) {
    for (const std::string& note : plan.why.notes) PrintError("note: {}\n", note);
  }
  if (!options.quiet && stats.unsettled_pixels > 0) {
    PrintError("note: {}; give more by --spp, or a larger --max-error\n",
               UnsettledNote(plan, stats));
  }
  WarnAboutSamples(counts, stats);
  if (!options.quiet && options.progress != "json") Summarize(options, plan, stats, times_);
  if (options.explain) PrintOut(ExplainPlan(plan, &stats));
  if (!options.stats.empty()) WriteText(options.stats, StatsJson(plan, stats, times_, counts));
}

void RunRenderJob(const RenderOptions& options, const std::vector<std::string>& inputs,
                  const std::function<Scene(const LoadOptions&)>& load,
                  const std::vector<TextItem>& captions) {
  RenderJob job(options, inputs);
  Scene scene;
  job.Load([&] { scene = load(job.load_options()); });
  try {
    job.Render(scene, nullptr, captions);
  } catch (const Cancelled&) {
    ThrowIfStopped();
    throw;
  }
}

}  // namespace nacre
