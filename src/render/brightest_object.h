// SPDX-License-Identifier: Apache-2.0
// render/brightest_object.h: how bright a small object can be: what adaptive sampling fears to
// miss.
#pragma once

#include "render/direct_plan.h"

namespace nacre {

// The largest mean radiance that the picture of a whole small object can have: `white`
// (WhiteLevel), or without one what area lights and skies make of it; infinite where that is not
// known.
double BrightestObject(const Scene& scene, const DirectPlan& direct, double white);

}  // namespace nacre
