// SPDX-License-Identifier: Apache-2.0
// compare/metrics.h: error metrics of an image against its reference, for each layer.
#pragma once

#include <limits>
#include <string>

#include "base/image.h"
#include "compare/layers.h"

namespace nacre {

// The location of a difference, in frame coordinates, with both images' values there.
struct DifferenceSite {
  int x = 0, y = 0;
  std::string channel;
  float got = 0, reference = 0;
};

// All numbers except the last are over samples that are finite in both images.
struct LayerMetrics {
  std::string layer;
  size_t samples = 0;  // pixels x channels compared, including those that are not finite
  double rmse = 0;
  // mean((got - reference)^2 / (reference^2 + 1e-4)), as in Rousselle et al. 2011 but with a
  // smaller constant, the square of kDarkReference, so that black pixels neither divide by zero nor
  // dominate. It is the mean of SoftenedError squared.
  double rel_mse = 0;
  double psnr_db = std::numeric_limits<double>::infinity();  // 20 log10(psnr_peak / rmse)
  double psnr_peak = 0;                                      // the largest |reference|
  double max_abs = 0;
  DifferenceSite max_abs_at;  // prefers a sample that is not finite in one image only
  // RelativeError over the samples with a nonzero reference: the maximum, and the 99.9th
  // percentile. Where the reference is 0, there is no relative error: samples that differ there are
  // counted.
  double max_rel = 0;
  double p999_rel = 0;
  size_t zero_mismatches = 0;
  double mean_got = 0, mean_reference = 0;
  size_t nonfinite_mismatches = 0;  // not finite in one image, and different in the other
};

LayerMetrics CompareLayer(const ImagePair& pair, const LayerPair& layer);

}  // namespace nacre
