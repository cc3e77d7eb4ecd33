// SPDX-License-Identifier: Apache-2.0
// compare/verdict.h: decides whether an image matches its reference within tolerances, and why not.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "compare/metrics.h"

namespace nacre {

// A sample exceeds the tolerances if |got - reference| > max_abs + max_rel |reference|, or if it is
// not finite in one image and differs in the other. A pixel exceeds them if any of its samples
// does, in any compared layer. By default, images must be equal. If only the RMSE is limited, with
// no tolerance for samples or pixels, it alone decides.
struct Tolerances {
  double max_abs = 0;
  double max_rel = 0;
  double exceeding_fraction = 0;  // fraction of pixels that may exceed these, in [0, 1]
  double rmse = std::numeric_limits<double>::infinity();  // limit for every layer
};

struct Verdict {
  bool match = false;
  std::string reason;  // one line in words
  size_t pixels = 0;
  size_t exceeding_pixels = 0;
  std::vector<LayerMetrics> layers;
};

// Images with different windows do not match, even if the pixels that both have are equal, unless
// options.crop allows it. Throws as PairImages does.
Verdict Judge(const Image& got, const Image& reference, const Tolerances& tolerances,
              const CompareOptions& options = {});

}  // namespace nacre
