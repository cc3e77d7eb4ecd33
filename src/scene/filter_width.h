// SPDX-License-Identifier: Apache-2.0
// scene/filter_width.h: the width of a pixel filter when a scene names only its kind.
#pragma once

#include "sampling/pixel_filter.h"

namespace nacre {

// The full support in pixels, as in PixelFilter::width.
constexpr double DefaultFilterWidth(FilterKind kind) {
  switch (kind) {
    case FilterKind::kBox:
      return 1;
    case FilterKind::kGaussian:
      return 3;  // six standard deviations
    case FilterKind::kBlackmanHarris:
      return 3.3;  // 1.1 pixels wide at half its height
    case FilterKind::kMitchell:
      return 4;  // its four cubic pieces, one pixel each (Mitchell and Netravali 1988)
  }
  return 1;
}

}  // namespace nacre
