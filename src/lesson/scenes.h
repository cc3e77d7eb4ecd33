// SPDX-License-Identifier: Apache-2.0
// lesson/scenes.h: scenes/textbook/*.json, compiled in: the lesson's two set-ups for nacre's own
// renderer, with real spheres and lights with fall-off.
#pragma once

#include "scene/scene.h"

namespace nacre {

Scene TextbookComparisonScene();
Scene TextbookGridScene();

}  // namespace nacre
