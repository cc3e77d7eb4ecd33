// SPDX-License-Identifier: Apache-2.0
// texture/sample_kernel.h: textures sampled at many points at once, by SIMD gathers.
#pragma once

#include <cstddef>

#include "texture/sample.h"

namespace nacre {

// Arrays of points. All arrays are read and written in whole vectors, up to 7 entries past `count`.
struct SamplePoints {
  const double* u;
  const double* v;
  TextureFootprint<const float*> footprint;  // read by trilinear look-ups; else may be null
  size_t count;
};

// to[c][i] is channel c of the image at point i; channels beyond the image's repeat its last one.
void SampleTexture(const MipChain& image, const SampleSettings& settings,
                   const SamplePoints& points, int channels, float* const* to);

// to_u[i] and to_v[i] are the derivatives of channel 0 with respect to u and v at point i, as by
// the scalar SampleSlopes of sample.h.
void SampleSlopes(const MipChain& image, const SampleSettings& settings, const SamplePoints& points,
                  float* to_u, float* to_v);

}  // namespace nacre
