// SPDX-License-Identifier: Apache-2.0
// render/brightest_object.h: an upper bound of the radiance of small objects. Adaptive sampling
// uses it to decide which objects are too small to matter if all samples miss them.
#pragma once

#include "render/lights_plan.h"

namespace nacre {

// An upper bound of the mean radiance of an object that is seen whole: `white` (WhiteLevel) if that
// is finite, else a bound from the area lights and skies. Infinite if no bound is known.
double BrightestObject(const Scene& scene, const LightsPlan& lights, double white);

}  // namespace nacre
