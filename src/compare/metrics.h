// SPDX-License-Identifier: Apache-2.0
// compare/metrics.h: how far an image is from its reference, layer by layer.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "base/image.h"
#include "compare/layers.h"

namespace nacre {

// Where a difference is: frame coordinates, with what both images have there.
struct DifferenceSite {
  int x = 0, y = 0;
  std::string channel;
  float got = 0, reference = 0;
};

// All figures but the last are over samples that are finite in both images.
struct LayerMetrics {
  std::string layer;
  size_t samples = 0;  // pixels x channels compared, all of them
  double rmse = 0;
  // mean((got - reference)^2 / (reference^2 + 1e-4)), Rousselle et al. 2011 with their constant
  // made smaller: the square of kDarkReference, so that black pixels neither divide by zero nor
  // drown the rest. The mean of SoftenedError squared.
  double rel_mse = 0;
  double psnr_db = std::numeric_limits<double>::infinity();  // 20 log10(psnr_peak / rmse)
  double psnr_peak = 0;                                      // the largest |reference|
  double max_abs = 0;
  DifferenceSite max_abs_at;  // a sample that is not finite in one image only goes first
  // RelativeError over the samples whose reference is not 0: the largest, and what 99.9 % of them
  // have at most. Where the reference is 0 no error is relative to it: those that differ there are
  // counted.
  double max_rel = 0;
  double p999_rel = 0;
  size_t zero_mismatches = 0;
  double mean_got = 0, mean_reference = 0;
  size_t nonfinite_mismatches = 0;  // not finite in one image, and not the same in the other
};

LayerMetrics CompareLayer(const ImagePair& pair, const LayerPair& layer);

}  // namespace nacre
