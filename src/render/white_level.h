// SPDX-License-Identifier: Apache-2.0
// render/white_level.h: the radiance of white, above which a pixel counts as a highlight.
#pragma once

#include "scene/scene.h"

namespace nacre {

// An upper bound of the radiance of everything except highlights: that of a white matte surface
// that faces all lights at their smallest distances from the scene's shapes, or of the background
// or the brightest emission if that is more. Infinite if there are lights with an extent or skies,
// whose highlights are no brighter than the lights. With very many spheres distances are estimated
// from a part of them.
double WhiteLevel(const Scene& scene);

// The largest radiance, in any channel, that a material of the scene emits, with its map.
double LargestEmission(const Scene& scene);

// Whether a material has the classic convention, which leaves out the factor 1/pi.
bool IsClassic(const Material& material);

}  // namespace nacre
