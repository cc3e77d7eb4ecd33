// SPDX-License-Identifier: Apache-2.0
// compare/flip_hdr.h: FLIP of linear pictures over a range of exposures: Andersson, Nilsson,
// Shirley and Akenine-Moeller 2021, "Visualizing Errors in Rendered High Dynamic Range Images".
#pragma once

#include "compare/flip.h"

namespace nacre {

// `count` exposures from `start` to `stop` stops, in equal steps; one: `start` alone.
struct ExposureRange {
  double start = 0, stop = 0;
  int count = 1;
};

// The paper's automatic choice: at `start` the reference's brightest luminance is shown at 0.85 of
// white, at `stop` its median is, and there are as many exposures as stops between, at least 2.
//
// Where more than half of the reference is black, as behind a lone object, the paper's `stop` is
// infinite; the median is then that of the rest. All black: 0 and 0, one exposure. Negative
// radiance counts as 0.
ExposureRange FlipExposures(const PictureView& reference);

// The largest FLIP of each pixel over the exposures, of linear radiance. Each exposure is shown
// through the paper's tone curve, Narkowicz's ACES at 0.6 of the radiance.
Plane HdrFlipMap(const PictureView& reference, const PictureView& test, const ExposureRange& range,
                 double pixels_per_degree);

}  // namespace nacre
