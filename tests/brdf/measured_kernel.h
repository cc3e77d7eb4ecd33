// SPDX-License-Identifier: Apache-2.0
// tests/brdf/measured_kernel.h: the SIMD form of measured BRDFs on arrays, for tests.
#pragma once

#include <vector>

#include "brdf/measured_table.h"

namespace nacre {

struct MeasuredQuery {
  Vec3f n{0, 0, 1}, tangent{1, 0, 0}, l{0, 0, 1}, v{0, 0, 1};
  float u0 = 0, u1 = 0;
};

struct MeasuredAnswer {
  Vec3f linear, nearest;  // f n.l
  Vec3f sample;
  float pdf = 0;
};

// On the active target, query by query.
std::vector<MeasuredAnswer> AskMeasured(const MeasuredBrdf& brdf,
                                        const std::vector<MeasuredQuery>& queries);

}  // namespace nacre
