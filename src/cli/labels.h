// SPDX-License-Identifier: Apache-2.0
// cli/labels.h: the scene's labels in the picture (--labels).
#pragma once

#include <cstdint>
#include <span>

#include "base/image.h"
#include "scene/scene.h"

namespace nacre {

// Draws each label beside the projection of its anchor, but none that would touch one before it.
// `rgb8` holds the pixels of `window` of the scene's frame.
void DrawLabels(const Scene& scene, const Window& window, std::span<uint8_t> rgb8);

}  // namespace nacre
