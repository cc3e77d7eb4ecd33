// SPDX-License-Identifier: Apache-2.0
// view/metrics.h: compares the present picture with the one kept as A, by the metrics of nacre
// compare.
#pragma once

#include "base/image.h"
#include "color/display.h"
#include "scene_io/json_text.h"

namespace nacre {

// Metrics of the beauty. SSIM and FLIP compare the display pictures. The images must have the same
// window.
Json BeautyMetricsJson(const Image& got, const Image& reference, const DisplaySettings& display);

}  // namespace nacre
