// sampling/pixel_filter.h: reconstruction filters, sampled by importance.
//
// A pixel's value is the integral of filter x image. Each pixel draws its own samples from the
// density |filter|, with weight sign(filter) (Ernst, Stamminger and Greiner 2006), so there is no
// splatting: a pixel depends on its own samples only.
#pragma once

#include <cstdint>

#include "base/vec.h"

namespace nacre {

enum class FilterKind : uint8_t { kBox, kGaussian, kBlackmanHarris, kMitchell };

struct PixelFilter {
  FilterKind kind = FilterKind::kBox;
  double width = 1;  // full support in pixels, in (0, 16]
};

}  // namespace nacre
