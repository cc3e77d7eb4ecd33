// SPDX-License-Identifier: Apache-2.0
// cli/render_job.h: the job that render, grid and pair share: loads a scene, renders it, writes
// files.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "cli/render_options.h"
#include "cli/stats_json.h"
#include "image_io/draw_text.h"
#include "render/prepared_scene.h"

namespace nacre {

// The steps of the job, which --watch repeats.
class RenderJob {
 public:
  // Checks options and outputs; `inputs` are the files that the command names. The options must
  // outlive this object. Throws Error.
  RenderJob(const RenderOptions& options, const std::vector<std::string>& inputs);
  RenderJob(const RenderJob&) = delete;  // load_options() refers to it
  RenderJob& operator=(const RenderJob&) = delete;

  // Options for scene_io. They may only be used within Load.
  const LoadOptions& load_options() const { return load_options_; }

  // Calls `load`, shows its progress and warnings, and refuses outputs that are files it has read.
  // Throws Error.
  void Load(const std::function<void()>& load);

  // Renders what has been loaded, writes the files and prints what the options ask for. `prepared`
  // holds data that earlier renders of the scene have left; null if there is only one render.
  // `captions`, if not empty, are drawn into PNG files instead of the scene's labels, in pixels of
  // the whole frame. Throws Error, and Cancelled once CancelFlag() (progress.h) is set.
  void Render(const Scene& scene, PreparedScene* prepared,
              const std::vector<TextItem>& captions = {});

 private:
  const RenderOptions& options_;
  LoadOptions load_options_;
  RenderSettings settings_;
  std::vector<std::string> paths_;  // the outputs
  std::set<std::string> read_;      // files that any load has read
  std::vector<std::string> warnings_;
  std::function<void(double)> on_load_progress_;
  std::chrono::steady_clock::time_point start_;
  JobTimes times_;
};

// Runs the whole job once. `load` loads the scene with the given options. Throws Error.
void RunRenderJob(const RenderOptions& options, const std::vector<std::string>& inputs,
                  const std::function<Scene(const LoadOptions&)>& load,
                  const std::vector<TextItem>& captions = {});

// nacre render --watch: renders the scene at `path`, and again whenever its files have changed,
// until a stop signal comes; returns the exit code for that signal. `environment` and `variant` are
// those of LoadOptions. Throws Error for errors before the first picture is written; later
// errors are printed.
int RunWatchJob(const RenderOptions& options, const std::filesystem::path& path,
                const std::filesystem::path& environment,
                const std::optional<std::string>& variant);

}  // namespace nacre
