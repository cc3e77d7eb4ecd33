// SPDX-License-Identifier: Apache-2.0
// shading/fast_sky.h: what a picture of the sky has in its fast mode, in the place of samples.
#pragma once

#include "light/harmonics.h"

namespace nacre {

struct FastSky {
  IrradianceHarmonics<float> harmonics;
};

}  // namespace nacre
