// SPDX-License-Identifier: Apache-2.0
// cli/perceptual_options.h: the options that ask for SSIM, FLIP and HDR-FLIP.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <CLI/App.hpp>

#include "compare/perceptual.h"

namespace nacre {

struct PerceptualArguments {
  std::vector<std::string> metrics;  // "ssim", "flip", "hdr_flip", "all" or "none"
  std::string tonemap = "neutral";
  double exposure = 0;
  double pixels_per_degree = kDefaultPixelsPerDegree;
  std::string exposures;  // "START,STOP" or "START,STOP,COUNT"; empty: from the reference
};

void AddPerceptualOptions(CLI::App* command, PerceptualArguments* arguments);

// Nothing if no such metric is asked for. Throws Error (usage).
std::optional<PerceptualOptions> MakePerceptualOptions(const PerceptualArguments& arguments);

}  // namespace nacre
