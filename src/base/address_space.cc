// SPDX-License-Identifier: Apache-2.0
#include "base/address_space.h"

#include <new>

#include <sys/mman.h>

namespace nacre {

void RequireAddressSpace(size_t bytes) {
  void* const place =
      mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (place == MAP_FAILED) throw std::bad_alloc();
  munmap(place, bytes);
}

}  // namespace nacre
