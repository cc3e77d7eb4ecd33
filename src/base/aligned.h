// SPDX-License-Identifier: Apache-2.0
// base/aligned.h: arrays for SIMD kernels: aligned, zeroed, and padded to whole vectors.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>

namespace nacre {

// Widest vector in bytes (AVX-512), also a cache line.
inline constexpr size_t kVectorBytes = 64;

// Batches are padded to a multiple of this many entries, the widest vector of floats, so that no
// kernel needs a loop for the remaining entries.
inline constexpr size_t kBatchPadding = kVectorBytes / sizeof(float);

constexpr size_t RoundUp(size_t value, size_t multiple) {
  return (value + multiple - 1) / multiple * multiple;
}

// A fixed-size, zero-initialised array of trivial T, aligned to kVectorBytes. Its allocation is
// rounded up to whole vectors, plus eight: from any entry below size(), a kernel may load and store
// as many entries as four vectors have floats. Fresh memory is not written: of large arrays, only
// the pages that are used take memory and time.
template <typename T>
class AlignedArray {
 public:
  AlignedArray() = default;
  explicit AlignedArray(size_t size) : size_(size) {
    // std::aligned_alloc does not know whether its memory is zero; std::calloc does.
    size_t space = Capacity(size) * sizeof(T) + kVectorBytes;
    void* const allocated = std::calloc(space, 1);
    if (allocated == nullptr) throw std::bad_alloc();
    void* aligned = allocated;
    std::align(kVectorBytes, space - kVectorBytes, aligned, space);
    data_ = {static_cast<T*>(aligned), Free{allocated}};
  }

  // A view of a part of another array, which must outlive it. `begin` must be aligned to a vector.
  AlignedArray(AlignedArray* whole, size_t begin, size_t size)
      : data_(whole->data() + begin, Free{nullptr}), size_(size) {}

  // The number of entries that are allocated for an array of this size.
  static constexpr size_t Capacity(size_t size) {
    return (RoundUp(size * sizeof(T), kVectorBytes) + 8 * kVectorBytes) / sizeof(T);
  }

  T* data() { return data_.get(); }
  const T* data() const { return data_.get(); }
  size_t size() const { return size_; }
  T& operator[](size_t i) { return data_.get()[i]; }
  const T& operator[](size_t i) const { return data_.get()[i]; }
  T* begin() { return data(); }
  T* end() { return data() + size_; }
  const T* begin() const { return data(); }
  const T* end() const { return data() + size_; }

 private:
  struct Free {
    void* allocated = nullptr;  // null for views
    void operator()(T*) const { std::free(allocated); }
  };
  std::unique_ptr<T[], Free> data_;
  size_t size_ = 0;
};

}  // namespace nacre
