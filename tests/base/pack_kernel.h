// SPDX-License-Identifier: Apache-2.0
// tests/base/pack_kernel.h: base/pack-inl.h, for tests.
#pragma once

#include <vector>

namespace nacre {

// The numbers x[i] above 0 as Pack keeps them, and as Unpack puts them back, on the active target.
struct PackedNumbers {
  std::vector<float> packed, unpacked;
};
PackedNumbers PackAndUnpack(const std::vector<float>& x);

}  // namespace nacre
