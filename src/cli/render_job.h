// SPDX-License-Identifier: Apache-2.0
// cli/render_job.h: the whole job behind render, grid and pair: scene in, files out.
#pragma once

#include <chrono>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "cli/render_options.h"
#include "cli/stats_json.h"
#include "image_io/draw_text.h"
#include "render/prepared_scene.h"

namespace nacre {

// The steps of the job, which --watch takes again and again.
class RenderJob {
 public:
  // Checks options and outputs; `inputs` are the files that the command names. The options must
  // outlive this. Throws Error.
  RenderJob(const RenderOptions& options, const std::vector<std::string>& inputs);
  RenderJob(const RenderJob&) = delete;  // load_options() refers to it
  RenderJob& operator=(const RenderJob&) = delete;

  // What scene_io is to be told. Usable inside of Load alone.
  const LoadOptions& load_options() const { return load_options_; }

  // Calls `load`, shows its progress and warnings, and refuses outputs that it has read. Throws
  // Error.
  void Load(const std::function<void()>& load);

  // Renders what has been loaded, writes the files and prints what the options ask for. `prepared`
  // has what earlier renders of the scene have left; null: there is only this one. `captions`,
  // if any, are drawn into PNG files in place of the scene's labels; they are in pixels of the
  // whole frame. Throws Error, and Cancelled once CancelFlag() (progress.h) is set.
  void Render(const Scene& scene, PreparedScene* prepared,
              const std::vector<TextItem>& captions = {});

 private:
  const RenderOptions& options_;
  LoadOptions load_options_;
  RenderSettings settings_;
  std::vector<std::string> paths_;  // of the outputs
  std::set<std::string> read_;      // files that the scene refers to, in all loads
  std::vector<std::string> warnings_;
  std::function<void(double)> on_load_progress_;
  std::chrono::steady_clock::time_point start_;
  JobTimes times_;
};

// All of it once. `load` gets what scene_io is to be told. Throws Error.
void RunRenderJob(const RenderOptions& options, const std::vector<std::string>& inputs,
                  const std::function<Scene(const LoadOptions&)>& load,
                  const std::vector<TextItem>& captions = {});

}  // namespace nacre
