// SPDX-License-Identifier: Apache-2.0
// tests/base/math_kernel.h: the SIMD logarithms, exponential and roots of src/base, for tests.
#pragma once

#include <vector>

namespace nacre {

// On the active target, of one number.
float EvaluateLog2(float x);
float EvaluateLog2OneMinus(float x, float c);
float EvaluateExp2(float y);

// The operations of base/target_ops-inl.h on the numbers x[i].
struct TargetOps {
  std::vector<float> reciprocal, reciprocal_sqrt, square_root, twice_square_root;
};
TargetOps EvaluateTargetOps(const std::vector<float>& x);

}  // namespace nacre
