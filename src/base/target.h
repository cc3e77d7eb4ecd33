// SPDX-License-Identifier: Apache-2.0
// base/target.h: the SIMD targets of nacre, and the one that this process uses.
//
// Kernels are compiled for all targets and dispatched at run time by Highway. Its choice holds for
// the whole process; PinTarget is therefore called once, before any rendering.
#pragma once

#include <string>
#include <vector>

namespace nacre {

enum class Target { kScalar, kSse4, kAvx2, kAvx3, kNeon };

// "scalar", "sse4", "avx2" or "avx3"; "neon" on arm64, which has no other.
std::string TargetName(Target target);

// The targets compiled in and supported by this CPU, slowest first.
std::vector<Target> SupportedTargets();

// Makes every kernel of this process run on `target`. Must be one of SupportedTargets().
void PinTarget(Target target);

// The target that kernels run on: the pinned one, else the best supported.
Target ActiveTarget();

}  // namespace nacre
