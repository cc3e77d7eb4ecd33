// SPDX-License-Identifier: Apache-2.0
// compare/perceptual.h: perceptual metrics, SSIM, FLIP and HDR-FLIP, for layers of colours.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "color/display.h"
#include "compare/flip.h"
#include "compare/layers.h"

namespace nacre {

struct PerceptualOptions {
  bool ssim = true, flip = true, hdr_flip = true;
  // How to show linear images for SSIM and FLIP. Images with metadata["transfer"] "display" are
  // shown unchanged.
  DisplaySettings display;
  double pixels_per_degree = kDefaultPixelsPerDegree;
  // The exposures of HDR-FLIP; missing ones are found from the reference.
  std::optional<double> start_exposure, stop_exposure;
  std::optional<int> exposures;
};

// Metrics that could not be measured are empty, and `notes` say why.
struct PerceptualMetrics {
  std::string layer;
  std::optional<double> ssim;  // 1: equal
  std::optional<double> flip_mean, flip_max;
  std::optional<double> hdr_flip_mean, hdr_flip_max;
  ExposureRange exposures;       // for HDR-FLIP
  Plane flip_map, hdr_flip_map;  // over the window that both images cover; empty if not measured
  std::vector<std::string> notes;
};

// One result for each compared layer with R, G and B, in the reference's order. Negative radiance
// counts as 0, as on a display. Throws as PairImages does.
std::vector<PerceptualMetrics> MeasurePerceptual(const Image& got, const Image& reference,
                                                 const PerceptualOptions& what,
                                                 const CompareOptions& options = {});

}  // namespace nacre
