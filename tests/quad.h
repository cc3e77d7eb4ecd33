// SPDX-License-Identifier: Apache-2.0
// tests/quad.h: IEEE's 128-bit float, 113 bits of significand, for references: in software, but
// exact where double products are.
#pragma once

#include <limits>

namespace nacre {

#if defined(__SIZEOF_FLOAT128__)
using Quad = __float128;
#else
// Where the type has no name of its own, long double is it: arm64.
using Quad = long double;
static_assert(std::numeric_limits<long double>::digits == 113);
#endif

}  // namespace nacre
