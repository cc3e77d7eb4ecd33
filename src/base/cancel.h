// SPDX-License-Identifier: Apache-2.0
// base/cancel.h: cancels work by a flag that any thread may set.
#pragma once

#include <atomic>

namespace nacre {

// A flag that cancels work when it becomes true; null: the work cannot be cancelled.
using CancelPointer = const std::atomic<bool>*;

// Thrown by work that has been cancelled.
struct Cancelled {};

inline bool IsCancelled(CancelPointer cancel) {
  return cancel != nullptr && cancel->load(std::memory_order_relaxed);
}
inline void ThrowIfCancelled(CancelPointer cancel) {
  if (IsCancelled(cancel)) throw Cancelled{};
}

}  // namespace nacre
