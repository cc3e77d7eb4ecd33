// SPDX-License-Identifier: Apache-2.0
// tests/targets.h: runs a test on every SIMD target that this machine has.
#pragma once

#include "base/target.h"
#include "catch.h"

namespace nacre {

// While alive, other targets may be pinned; then the one that was active is again, also when a
// failed REQUIRE throws its way out.
class TargetGuard {
 public:
  TargetGuard() = default;
  ~TargetGuard() { PinTarget(before_); }
  TargetGuard(const TargetGuard&) = delete;
  TargetGuard& operator=(const TargetGuard&) = delete;

 private:
  Target before_ = ActiveTarget();
};

// Calls body(target) with each supported target pinned.
template <class Body>
void ForEachTarget(const Body& body) {
  const TargetGuard guard;
  for (const Target target : SupportedTargets()) {
    CAPTURE(TargetName(target));
    PinTarget(target);
    body(target);
  }
}

}  // namespace nacre
