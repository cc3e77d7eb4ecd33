// SPDX-License-Identifier: Apache-2.0
// view/metrics.h: how far the present picture is from the one kept as A, in the figures of nacre
// compare.
#pragma once

#include "base/image.h"
#include "color/display.h"
#include "scene_io/json_text.h"

namespace nacre {

// Of the beauty. SSIM and FLIP are of what the display shows. The images have the same window.
Json BeautyMetricsJson(const Image& got, const Image& reference, const DisplaySettings& display);

}  // namespace nacre
