// SPDX-License-Identifier: Apache-2.0
// cli/labels.h: draws the scene's labels into the picture (--labels).
#pragma once

#include <cstdint>
#include <span>

#include "base/image.h"
#include "scene/scene.h"

namespace nacre {

// Draws each label beside the projection of its anchor, unless it would touch one drawn before.
// `rgb8` holds the pixels of `window` of the scene's frame.
void DrawLabels(const Scene& scene, const Window& window, std::span<uint8_t> rgb8);

}  // namespace nacre
