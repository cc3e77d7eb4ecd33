// SPDX-License-Identifier: Apache-2.0
// cli/perceptual_options.h: the options for the metrics SSIM, FLIP and HDR-FLIP.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <CLI/App.hpp>

#include "compare/perceptual.h"

namespace nacre {

struct PerceptualArguments {
  std::vector<std::string> metrics;  // "ssim", "flip", "hdr_flip", "all" or "none"
  DisplaySettings display;
  double pixels_per_degree = kDefaultPixelsPerDegree;
  std::string exposures;  // "START,STOP" or "START,STOP,COUNT"; empty: found from the reference
};

void AddPerceptualOptions(CLI::App* command, PerceptualArguments* arguments);

// nullopt if no such metric is requested. Throws Error (kUsage).
std::optional<PerceptualOptions> MakePerceptualOptions(const PerceptualArguments& arguments);

}  // namespace nacre
