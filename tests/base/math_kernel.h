// SPDX-License-Identifier: Apache-2.0
// tests/base/math_kernel.h: the SIMD logarithms and the exponential of src/base, for tests.
#pragma once

namespace nacre {

// On the active target, of one number.
float EvaluateLog2(float x);
float EvaluateLog2OneMinus(float x, float c);
float EvaluateExp2(float y);

}  // namespace nacre
