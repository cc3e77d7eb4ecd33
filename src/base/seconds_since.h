// SPDX-License-Identifier: Apache-2.0
// base/seconds_since.h: wall-clock durations.
#pragma once

#include <chrono>

namespace nacre {

inline double SecondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace nacre
