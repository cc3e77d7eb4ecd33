// SPDX-License-Identifier: Apache-2.0
// base/huge_pages.h: large arrays in 2 MiB pages, if the system offers them: fewer page faults at
// the first access, and fewer TLB misses with random access.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

namespace nacre {

// Asks for such pages for memory that has not been accessed yet. A hint only, without effect on
// small blocks.
void AdviseHugePages(void* data, size_t bytes);

// A fixed-size, uninitialised array of T without destructor: its pages are allocated by the threads
// that first write to them.
template <typename T>
class HugeArray {
 public:
  HugeArray() = default;
  explicit HugeArray(size_t size) : size_(size) {
    static_assert(std::is_trivially_destructible_v<T>);
    data_.reset(static_cast<T*>(std::malloc(size * sizeof(T))));
    if (!data_ && size > 0) throw std::bad_alloc();
    AdviseHugePages(data_.get(), size * sizeof(T));
  }

  T* data() { return data_.get(); }
  const T* data() const { return data_.get(); }
  size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  T& operator[](size_t i) { return data_.get()[i]; }
  const T& operator[](size_t i) const { return data_.get()[i]; }
  T* begin() { return data(); }
  T* end() { return data() + size_; }
  const T* begin() const { return data(); }
  const T* end() const { return data() + size_; }

 private:
  struct Free {
    void operator()(T* p) const { std::free(p); }
  };
  std::unique_ptr<T[], Free> data_;
  size_t size_ = 0;
};

// An allocator for vectors of numbers in huge pages. New elements stay uninitialised unless they
// are given a value, so that resize() writes nothing.
template <typename T>
struct HugeAllocator {
  using value_type = T;
  HugeAllocator() = default;
  template <typename U>
  // NOLINTNEXTLINE(google-explicit-constructor): as allocators do
  HugeAllocator(const HugeAllocator<U>&) {}

  T* allocate(size_t count) {
    T* const data = std::allocator<T>().allocate(count);
    AdviseHugePages(data, count * sizeof(T));
    return data;
  }
  void deallocate(T* data, size_t count) { std::allocator<T>().deallocate(data, count); }
  template <typename U>
  void construct(U* place) {
    static_assert(std::is_trivially_default_constructible_v<U>);
    ::new (static_cast<void*>(place)) U;
  }
  template <typename U, typename... Arguments>
  void construct(U* place, Arguments&&... arguments) {
    ::new (static_cast<void*>(place)) U(std::forward<Arguments>(arguments)...);
  }
  friend bool operator==(const HugeAllocator&, const HugeAllocator&) { return true; }
};

template <typename T>
using HugeVector = std::vector<T, HugeAllocator<T>>;

}  // namespace nacre
