// SPDX-License-Identifier: Apache-2.0
// render/white_level.h: the radiance of white, above which a pixel counts as a highlight, and an
// upper bound of that of small objects, which tells adaptive sampling which of them are too small
// to matter if all samples miss them.
#pragma once

#include "render/lights_plan.h"

namespace nacre {

// An upper bound of the radiance of everything except highlights: that of a white matte surface
// that faces all lights at their smallest distances from the scene's shapes, or of the background
// or the brightest emission if that is more. Infinite if there are lights with an extent or skies,
// whose highlights are no brighter than the lights. With very many spheres distances are estimated
// from a part of them.
double WhiteLevel(const Scene& scene);

// An upper bound of the mean radiance of an object that is seen whole: `white` (WhiteLevel) if that
// is finite, else a bound from the area lights and skies. Infinite if no bound is known.
double BrightestObject(const Scene& scene, const LightsPlan& lights, double white);

}  // namespace nacre
