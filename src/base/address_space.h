// SPDX-License-Identifier: Apache-2.0
// base/address_space.h: whether memory is left, asked before a library that cannot tell.
#pragma once

#include <cstddef>

namespace nacre {

// Throws std::bad_alloc if the process cannot map `bytes` more. Maps and unmaps them, untouched:
// what malloc takes, it may keep when it is given back, and another allocator then finds nothing.
void RequireAddressSpace(size_t bytes);

}  // namespace nacre
