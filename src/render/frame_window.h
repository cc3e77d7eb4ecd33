// SPDX-License-Identifier: Apache-2.0
// render/frame_window.h: which pixels of the frame a render is to make.
#pragma once

#include "base/image.h"
#include "render/settings.h"

namespace nacre {

// The settings' region or band of the frame. Throws Error (usage) for a region that holds no pixel,
// and for a band of more than MostBands.
Window FrameWindow(const Window& frame, const RenderSettings& settings);

// Into how many bands the frame can be cut, each of `band_rows` rows or a multiple of them, the
// last of what is left.
int MostBands(const Window& frame, int band_rows);

}  // namespace nacre
