// SPDX-License-Identifier: Apache-2.0
// tests/brdf/layer_kernel.h: the SIMD sheen and fuzz of src/brdf on arrays, in vectors of
// floats and of doubles, for tests.
#pragma once

#include <vector>

#include "base/vec.h"

namespace nacre {

template <typename T>
struct LayerQuery {
  Imath::Vec3<T> n, l, v;
  T roughness = 0;
  T largest_channel = 1;  // of the sheen's colour
};

template <typename T>
struct LayerAnswer {
  T distribution = 0, sheen = 0;             // D and D V of Charlie
  T cosine_lambda_v = 0;                     // n.v Lambda(n.v)
  T sheen_albedo_v = 0, sheen_albedo_l = 0;  // E(n.v), E(n.l)
  T sheen_scale = 0, below_sheen = 0;
  T fuzz_albedo = 0, fuzz_a = 0, fuzz_tilt = 0;  // FuzzFromView
  T fuzz = 0, fuzz_pdf = 0;
};

// On the active target, query by query: lanes have a roughness each, or all lanes of a vector that
// of its first, as hits with and without maps have.
enum class RoughnessOf { kEach, kFirst };
template <typename T>
std::vector<LayerAnswer<T>> EvaluateLayers(RoughnessOf roughness,
                                           const std::vector<LayerQuery<T>>& queries);

}  // namespace nacre
