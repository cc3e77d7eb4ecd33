// SPDX-License-Identifier: Apache-2.0
// base/strip.h: the strips that pictures are rendered and written by.
#pragma once

#include <algorithm>

namespace nacre {

// Rows of a strip, counted from the picture's top; the last one may have fewer. The unit of
// parallel work and of output: EXR's ZIP compresses 16 rows at a time, and 16 rows of all that is
// needed stay in L2.
inline constexpr int kStripRows = 16;

inline int StripCount(int height) { return (height + kStripRows - 1) / kStripRows; }

// Rows of the strip that begins at row `y`.
inline int StripRows(int y, int height) { return std::min(kStripRows, height - y); }

}  // namespace nacre
