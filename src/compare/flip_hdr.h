// SPDX-License-Identifier: Apache-2.0
// compare/flip_hdr.h: FLIP for linear pictures over a range of exposures: Andersson, Nilsson,
// Shirley and Akenine-Moeller 2021, "Visualizing Errors in Rendered High Dynamic Range Images".
#pragma once

#include "compare/flip.h"

namespace nacre {

// `count` exposures from `start` to `stop` stops, equally spaced; if there is one, it is `start`.
struct ExposureRange {
  double start = 0, stop = 0;
  int count = 1;
};

// The paper's automatic choice: at `start`, the reference's brightest luminance is shown at 0.85 of
// white; at `stop`, its median is. There are as many exposures as stops between them, at least 2.
//
// Where more than half of the reference is black, as behind a single object, the paper's `stop`
// would be infinite; then the median of the other pixels is used. If all are black, the range is
// one exposure of 0. Negative radiance counts as 0.
ExposureRange FlipExposures(const PictureView& reference);

// FLIP for linear radiance: the maximum for each pixel over the exposures. Each exposure is shown
// through the paper's tone curve, Narkowicz's ACES at 0.6 of the radiance.
Plane HdrFlipMap(const PictureView& reference, const PictureView& test, const ExposureRange& range,
                 double pixels_per_degree);

}  // namespace nacre
