// SPDX-License-Identifier: Apache-2.0
// base/pool.h: objects that threads borrow and give back, such as buffers for scratch that are
// costly to allocate.
//
// A `thread_local` object with a destructor would do the same, but glibc aborts the process where
// it has no memory to remember the destructor; here, Borrow() throws std::bad_alloc.
#pragma once

#include <memory>
#include <mutex>
#include <vector>

namespace nacre {

template <class T>
class Pool {
 public:
  struct GiveBack {
    Pool* pool;
    void operator()(T* object) const noexcept {
      const std::lock_guard lock(pool->mutex_);
      pool->free_.emplace_back(object);  // Borrow() has reserved its place
    }
  };
  using Borrowed = std::unique_ptr<T, GiveBack>;

  // An object as its last borrower left it, or a new T{}. It goes back when the pointer ends, which
  // the pool must outlive. Throws what T{} throws.
  Borrowed Borrow() {
    {
      const std::lock_guard lock(mutex_);
      if (!free_.empty()) {
        T* const object = free_.back().release();
        free_.pop_back();
        return {object, {this}};
      }
      free_.reserve(++count_);
    }
    return {new T{}, {this}};
  }

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<T>> free_;
  size_t count_ = 0;  // of all that were made
};

}  // namespace nacre
