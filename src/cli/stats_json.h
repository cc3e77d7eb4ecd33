// SPDX-License-Identifier: Apache-2.0
// cli/stats_json.h: times and counts of a render as JSON (--stats, --dry-run).
#pragma once

#include <optional>
#include <string>

#include "cli/outputs.h"
#include "render/forecast.h"
#include "render/frame_plan.h"
#include "render/stats.h"

namespace nacre {

// Wall-clock times of the parts of a job besides the render itself.
struct JobTimes {
  double load_seconds = 0;    // reading and validating the scene
  double finish_seconds = 0;  // completing the files after the last strip
  double total_seconds = 0;
  std::optional<Forecast> forecast;  // of the render
};

std::string StatsJson(const FramePlan& plan, const RenderStats& stats, const JobTimes& times,
                      const OutputCounts& counts);

// The output of --dry-run: everything that affects the picture's bits, as in its header.
std::string DryRunJson(const ExrHeader& header, const RenderOptions& options, int most_tiles);

}  // namespace nacre
