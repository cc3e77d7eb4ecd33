// SPDX-License-Identifier: Apache-2.0
// tests/stress/leaks.h: rays from inside closed meshes at their vertices and edges: none may get
// out.
#pragma once

#include <cstdint>
#include <functional>

namespace nacre {

struct LeakSettings {
  uint64_t rays = 1'000'000;  // in all; whole batches
  uint64_t seed = 1;
  int threads = 0;
  std::function<void(double)> on_progress{};  // with the share done
};

struct LeakResult {
  uint64_t rays = 0;
  uint64_t leaks = 0;  // rays that hit nothing
};

// Icospheres of 5120 faces, with radii from 1e-6 to 1e6 and centres up to 1e3 radii from the eye,
// on the active target.
LeakResult CountLeaks(const LeakSettings& settings);

}  // namespace nacre
