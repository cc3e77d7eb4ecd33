// SPDX-License-Identifier: Apache-2.0
// render/frame_window.h: the window of the frame that is rendered.
#pragma once

#include "base/image.h"
#include "render/settings.h"

namespace nacre {

// The pixels of the settings' region or band; else all pixels of the frame. Throws Error (usage)
// for a region that holds no pixel, and for more than MaxBands bands.
Window FrameWindow(const Window& frame, const RenderSettings& settings);

// The largest number of bands that the frame can be divided into. Bands have a multiple of
// `band_rows` rows; the last has the rest.
int MaxBands(const Window& frame, int band_rows);

}  // namespace nacre
