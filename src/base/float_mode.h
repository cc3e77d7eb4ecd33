// SPDX-License-Identifier: Apache-2.0
// base/float_mode.h: the floating-point modes that results depend on. A caller of the library may
// round towards zero, trap divisions or flush denormals, and threads inherit the modes of the
// thread that starts them. Pictures must not depend on that.
#pragma once

#include <cstdint>

namespace nacre {

enum class Denormals : uint8_t { kKept, kFlushed };

// Sets the modes of this thread: rounding to nearest, full precision, no traps, and denormals as
// given. Returns the previous modes, for LeaveFloatMode to restore.
uint64_t EnterFloatMode(Denormals denormals);
void LeaveFloatMode(uint64_t before);

// While alive, this thread has the modes that a process begins with; then the caller's modes are
// restored. Every function of the public API holds one.
class DefaultFloatMode {
 public:
  DefaultFloatMode() : before_(EnterFloatMode(Denormals::kKept)) {}
  ~DefaultFloatMode() { LeaveFloatMode(before_); }
  DefaultFloatMode(const DefaultFloatMode&) = delete;
  DefaultFloatMode& operator=(const DefaultFloatMode&) = delete;

 private:
  uint64_t before_;
};

}  // namespace nacre
