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

// While alive, this thread has these modes; then the caller's modes are restored.
class FloatMode {
 public:
  explicit FloatMode(Denormals denormals) : before_(EnterFloatMode(denormals)) {}
  ~FloatMode() { LeaveFloatMode(before_); }
  FloatMode(const FloatMode&) = delete;
  FloatMode& operator=(const FloatMode&) = delete;

 private:
  uint64_t before_;
};

// The modes that a process begins with. Every function of the public API holds one.
struct DefaultFloatMode : FloatMode {
  DefaultFloatMode() : FloatMode(Denormals::kKept) {}
};

// Denormals are treated as zero (FTZ and DAZ on x86, FZ on arm64): the tails of highlights make
// them, and each costs a hundred cycles on x86. Every worker of ParallelFor holds one.
struct FlushDenormals : FloatMode {
  FlushDenormals() : FloatMode(Denormals::kFlushed) {}
};

}  // namespace nacre
