// tests/targets.h: runs a test on every SIMD target that this machine has.
#pragma once

#include "base/target.h"
#include "catch.h"

namespace nacre {

// Calls body(target) with each supported target pinned, then pins the best one again.
template <class Body>
void ForEachTarget(const Body& body) {
  for (const Target target : SupportedTargets()) {
    CAPTURE(TargetName(target));
    PinTarget(target);
    body(target);
  }
  PinTarget(SupportedTargets().back());
}

}  // namespace nacre
