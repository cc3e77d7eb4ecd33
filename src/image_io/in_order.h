// SPDX-License-Identifier: Apache-2.0
// image_io/in_order.h: writes in order what several threads finish in any order.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <utility>

#include "base/error.h"

namespace nacre {

// A reorder buffer. Items 0, 1, 2, ... are passed to `write` in this order, one at a time, by
// whichever thread adds the item that is next; no thread waits for another.
template <typename Item>
class InOrder {
 public:
  using WriteFunction = std::function<void(size_t index, const Item& item)>;

  explicit InOrder(WriteFunction write) : write_(std::move(write)) {}

  // May be called from any thread. Throws what `write` throws; no item is written after that.
  void Add(size_t index, Item item) {
    std::unique_lock lock(mutex_);
    if (index < next_ || !waiting_.emplace(index, std::move(item)).second) {
      throw Error(ExitCode::kInternal, "", "strip " + std::to_string(index) + " came twice");
    }
    if (writing_) return;
    writing_ = true;  // remains true if write_ throws
    while (const auto node = waiting_.extract(next_)) {
      lock.unlock();
      write_(node.key(), node.mapped());
      lock.lock();
      ++next_;
    }
    writing_ = false;
  }

  // The number of items written.
  size_t count() const {
    const std::lock_guard lock(mutex_);
    return next_;
  }

 private:
  const WriteFunction write_;
  mutable std::mutex mutex_;
  std::map<size_t, Item> waiting_;
  size_t next_ = 0;
  bool writing_ = false;
};

}  // namespace nacre
