// SPDX-License-Identifier: Apache-2.0
// tests/brdf/diffuse_kernel.h: the SIMD diffuse models of src/brdf on arrays, for tests.
#pragma once

#include <vector>

#include "base/vec.h"

namespace nacre {

struct DiffuseQuery {
  Vec3f n, l, v;
  float albedo = 1, roughness = 0;
};

struct DiffuseAnswer {
  float eon = 0, burley = 0;  // the latter per unit of albedo
};

// On the active target, query by query.
std::vector<DiffuseAnswer> EvaluateDiffuse(const std::vector<DiffuseQuery>& queries);

}  // namespace nacre
