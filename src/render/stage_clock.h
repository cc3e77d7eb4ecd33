// SPDX-License-Identifier: Apache-2.0
// render/stage_clock.h: measures how long each stage of the work takes.
#pragma once

#include <array>
#include <chrono>

#include "render/stats.h"

namespace nacre {

// Charges the time since the last call to a stage. The destructor adds the times to the stats. The
// total comes from the system's clock, and its division into stages from the processor's counter:
// the system's clock at each call would take a twentieth of the time.
class StageClock {
 public:
  // Measures nothing if `stats` is null.
  explicit StageClock(RenderStats* stats) : stats_(stats) {}
  StageClock(const StageClock&) = delete;
  StageClock& operator=(const StageClock&) = delete;
  ~StageClock() {
    if (stats_ == nullptr) return;
    const double seconds = std::chrono::duration<double>(Clock::now() - start_).count();
    const auto ticks = static_cast<double>(Ticks() - first_tick_);
    if (!(ticks > 0)) return;
    for (size_t i = 0; i < kStageCount; ++i) {
      stats_->stage_seconds[i] += seconds * (static_cast<double>(stage_ticks_[i]) / ticks);
    }
  }

  void Charge(Stage stage) {
    if (stats_ == nullptr) return;
    const uint64_t now = Ticks();
    stage_ticks_[static_cast<size_t>(stage)] += now - last_tick_;
    last_tick_ = now;
  }

 private:
  using Clock = std::chrono::steady_clock;

  static uint64_t Ticks() {
#if defined(__x86_64__)
    return __builtin_ia32_rdtsc();
#else
    return static_cast<uint64_t>(Clock::now().time_since_epoch().count());
#endif
  }

  RenderStats* stats_;
  Clock::time_point start_ = Clock::now();
  uint64_t first_tick_ = Ticks();
  uint64_t last_tick_ = first_tick_;
  std::array<uint64_t, kStageCount> stage_ticks_{};
};

}  // namespace nacre
