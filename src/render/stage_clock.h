// render/stage_clock.h: where a worker's time goes.
#pragma once

#include <chrono>

#include "render/stats.h"

namespace nacre {

// Charges the time since the last call to a stage.
class StageClock {
 public:
  explicit StageClock(RenderStats* stats) : stats_(stats) {}
  void Charge(Stage stage) {
    const auto now = std::chrono::steady_clock::now();
    stats_->seconds(stage) += std::chrono::duration<double>(now - last_).count();
    last_ = now;
  }

 private:
  RenderStats* stats_;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace nacre
