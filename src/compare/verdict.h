// SPDX-License-Identifier: Apache-2.0
// compare/verdict.h: whether an image matches its reference within given tolerances, and why not.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "compare/metrics.h"

namespace nacre {

// A sample exceeds them if |got - reference| > max_abs + max_rel |reference|, or if it is not
// finite in one image and not the same in the other. A pixel exceeds them if a sample of it does,
// in any layer compared. By default images must be equal. A limit of the RMSE alone, with nothing
// said of samples or pixels, is the whole verdict.
struct Tolerances {
  double max_abs = 0;
  double max_rel = 0;
  double exceeding_fraction = 0;  // of the pixels that may exceed these, in [0, 1]
  double rmse = std::numeric_limits<double>::infinity();  // that no layer may exceed
};

struct Verdict {
  bool match = false;
  std::string reason;  // one line in words
  size_t pixels = 0;
  size_t exceeding_pixels = 0;
  std::vector<LayerMetrics> layers;
};

// Images whose windows differ do not match, however equal the pixels are that both have, unless
// options.crop allows it. Throws as PairImages does.
Verdict Judge(const Image& got, const Image& reference, const Tolerances& tolerances,
              const CompareOptions& options = {});

}  // namespace nacre
