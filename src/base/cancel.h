// SPDX-License-Identifier: Apache-2.0
// base/cancel.h: work that is ended before it is done, by a flag that any thread may set.
#pragma once

#include <atomic>

namespace nacre {

// null: nobody can ask for it.
using CancelPointer = const std::atomic<bool>*;

// Thrown by work that was ended.
struct Cancelled {};

inline bool IsCancelled(CancelPointer cancel) {
  return cancel != nullptr && cancel->load(std::memory_order_relaxed);
}
inline void ThrowIfCancelled(CancelPointer cancel) {
  if (IsCancelled(cancel)) throw Cancelled{};
}

}  // namespace nacre
