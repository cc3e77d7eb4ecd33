// SPDX-License-Identifier: Apache-2.0
// compare/flip.h: FLIP, the difference that a viewer perceives when flipping between two pictures:
// Andersson, Nilsson, Akenine-Moeller, Oskarsson, Astroem and Fairchild 2020, "FLIP: A Difference
// Evaluator for Alternating Images".
#pragma once

#include <span>

#include "compare/plane.h"

namespace nacre {

// Pixels per degree of vision for a display with 3840 pixels on 0.7 m, seen from 0.7 m. As in the
// paper, this is for the degree straight ahead: distance * pixels / width * pi / 180.
inline constexpr double kDefaultPixelsPerDegree = 67.020643276582255;

// FLIP in [0, 1] for each pixel, as the maximum over all ways of showing the pictures; 0: no
// difference. It is symmetric in the pictures, which must have the same size, of any number of
// pixels.
//
// Computed in float; tests/compare/flip_twin.h does the same in double. The mean is within 1e-6 of
// that. Pixels are within 1e-4, except those with a strong feature and hardly any colour
// difference, which are within 1e-3: float rounds colours by 3e-5 of L*'s 100, which turns a colour
// error of 0 into 4e-5, and the feature takes a root of it. Pixels are exactly 0 where everything
// that the filters read is equal.
Plane FlipMap(const PictureView& reference, const PictureView& test,
              std::span<const ShowPair> shows, double pixels_per_degree);

// ---- Linear pictures over a range of exposures --------------------------------------------------

// Andersson, Nilsson, Shirley and Akenine-Moeller 2021, "Visualizing Errors in Rendered High
// Dynamic Range Images".

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
