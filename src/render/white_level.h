// SPDX-License-Identifier: Apache-2.0
// render/white_level.h: what counts as a highlight.
#pragma once

#include "scene/scene.h"

namespace nacre {

// The radiance that a white matte surface has where the scene's lights are nearest to its shapes
// and all shine on it face to face; or more, if the background or a material that emits has more.
// Only highlights are brighter. Infinite under lights with an extent and skies, whose reflections
// are no brighter than they are. Of very many spheres some stand for all.
double WhiteLevel(const Scene& scene);

// The largest radiance that a material emits, its map included.
double LargestEmission(const Scene& scene);

// Whether a material leaves 1/pi out, as lessons do.
bool IsClassic(const Material& material);

}  // namespace nacre
