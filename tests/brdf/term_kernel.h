// SPDX-License-Identifier: Apache-2.0
// tests/brdf/term_kernel.h: the SIMD terms of src/brdf evaluated on arrays, for tests against
// their scalar twins and the tables.
#pragma once

#include <cstddef>
#include <vector>

#include "base/vec.h"

namespace nacre {

struct TermInput {
  Vec3f n, l, v;  // unit
  float shininess, roughness, f0;
};

struct TermOutput {
  float phong, blinn;                                               // ungated lobes
  float distribution;                                               // GGX
  float height_correlated, separable, schlick_direct, schlick_ibl;  // visibility terms
  float fresnel;                                                    // Schlick
  float u_squared;                                                  // of the half vector's angles
};

// On the active target.
std::vector<TermOutput> EvaluateTerms(const std::vector<TermInput>& inputs);

}  // namespace nacre
