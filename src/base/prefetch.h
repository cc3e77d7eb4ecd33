// SPDX-License-Identifier: Apache-2.0
// base/prefetch.h: lines of cache that a loop will write, asked for ahead of it.
//
// The arrays of a batch lie in L2. What is read processors fetch ahead by themselves; a store waits
// until L1 owns its line, and those behind it wait for it. With these on a Xeon the exact hits of
// the material grid take 0.78 of the time, and 0.92 without their positions.
#pragma once

#include <cstddef>

namespace nacre {

// Four lines, in bytes: of two to eight the best or as good.
inline constexpr size_t kWriteAhead = 256;

// `to`: where a loop is about to write, ever further on. Past the array's end it does no harm.
template <typename T>
inline void PrefetchToWrite(const T* to) {
  const char* const ahead = reinterpret_cast<const char*>(to) + kWriteAhead;
#if defined(__x86_64__)
  // Left to itself, GCC fetches to read, which gains nothing here: the line's owner stays another.
  // Processors that do not know the instruction pass over it.
  asm volatile("prefetchw %0" : : "m"(*ahead));
#else
  __builtin_prefetch(ahead, 1);
#endif
}

}  // namespace nacre
