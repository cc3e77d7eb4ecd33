// SPDX-License-Identifier: Apache-2.0
// tests/stress/random_scene.h: small scenes of spheres at random: of any size, anywhere, seen from
// near and far, in, on and between spheres, under lights that graze or touch.
#pragma once

#include <cstdint>

#include "scene/scene.h"

namespace nacre {

// The same scene for the same seed, everywhere. It is valid (scene/validate.h).
Scene MakeRandomScene(uint64_t seed);

// By how much these scenes may exceed RadianceBound (stress/gallery.h), which the gallery keeps:
// on the flanks of a Phong lobe of exponent n, an angle a from its axis, the rounding of directions
// to float alone makes n a 2^-23, and nothing but the lobe may light the surface there.
inline constexpr double kRandomSceneSlack = 2;

}  // namespace nacre
