// SPDX-License-Identifier: Apache-2.0
// compare/perceptual.h: metrics of what is seen: SSIM, FLIP and HDR-FLIP of the layers that are
// colours.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "color/display.h"
#include "compare/flip_hdr.h"
#include "compare/layers.h"

namespace nacre {

struct PerceptualOptions {
  bool ssim = true, flip = true, hdr_flip = true;
  // How linear images are shown, for SSIM and FLIP. Those of metadata["transfer"] "display" are
  // shown as they are.
  DisplaySettings display;
  double pixels_per_degree = kDefaultPixelsPerDegree;
  // HDR-FLIP's exposures; what is missing comes from the reference.
  std::optional<double> start_exposure, stop_exposure;
  std::optional<int> exposures;
};

// What could not be measured is empty, and `notes` say why.
struct PerceptualMetrics {
  std::string layer;
  std::optional<double> ssim;  // 1: equal
  std::optional<double> flip_mean, flip_max;
  std::optional<double> hdr_flip_mean, hdr_flip_max;
  ExposureRange exposures;       // of HDR-FLIP
  Plane flip_map, hdr_flip_map;  // over the window that both images cover; empty if missing
  std::vector<std::string> notes;
};

// One for each layer compared that has R, G and B, in the reference's order. Negative radiance
// counts as 0, as a display shows it. Throws as PairImages does.
std::vector<PerceptualMetrics> MeasurePerceptual(const Image& got, const Image& reference,
                                                 const PerceptualOptions& what,
                                                 const CompareOptions& options = {});

}  // namespace nacre
