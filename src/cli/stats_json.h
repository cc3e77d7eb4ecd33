// SPDX-License-Identifier: Apache-2.0
// cli/stats_json.h: times and counts of a render for programs (--stats, --dry-run).
#pragma once

#include <optional>
#include <string>

#include "cli/outputs.h"
#include "render/forecast.h"
#include "render/frame_plan.h"
#include "render/stats.h"

namespace nacre {

// Wall times of a job's parts around the render itself.
struct JobTimes {
  double load_seconds = 0;    // reading and checking the scene
  double finish_seconds = 0;  // completing the files after the last strip
  double total_seconds = 0;
  std::optional<Forecast> forecast;  // of the render
};

std::string StatsJson(const FramePlan& plan, const RenderStats& stats, const JobTimes& times,
                      const OutputCounts& counts);

// What --dry-run prints: all that decides the picture's bits, as its header has it.
std::string DryRunJson(const ExrHeader& header, const RenderOptions& options, int most_tiles);

}  // namespace nacre
