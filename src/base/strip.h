// SPDX-License-Identifier: Apache-2.0
// base/strip.h: the strips in which pictures are rendered and written.
#pragma once

#include <algorithm>

namespace nacre {

// The number of rows of a strip, from the picture's top; the last strip may have fewer. The unit of
// parallel work and of output: EXR's ZIP compresses 16 rows at a time, and the data of 16 rows fit
// into the L2 cache.
inline constexpr int kStripRows = 16;

inline int StripCount(int height) { return (height + kStripRows - 1) / kStripRows; }

// The number of rows of the strip that begins at row `y`.
inline int StripRows(int y, int height) { return std::min(kStripRows, height - y); }

}  // namespace nacre
