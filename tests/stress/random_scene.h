// tests/stress/random_scene.h: small scenes of spheres at random: of any size, anywhere, seen from
// near and far, in, on and between spheres, under lights that graze or touch.
#pragma once

#include <cstdint>

#include "scene/scene.h"

namespace nacre {

// The same scene for the same seed, everywhere. It is valid (scene/validate.h).
Scene MakeRandomScene(uint64_t seed);

}  // namespace nacre
