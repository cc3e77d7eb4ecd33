// SPDX-License-Identifier: Apache-2.0
// scene_io/scene_budget.h: how much more may be made of a file. A few bytes can ask for a hundred
// million spheres, and for them again and again.
#pragma once

#include <cstdint>

#include <fmt/format.h>

#include "base/error.h"
#include "scene/limits.h"

namespace nacre {

class SceneBudget {
 public:
  // What a sphere with a material of its own counts: such a pair is about as large as that many.
  static constexpr uint64_t kWithMaterial = 16;

  explicit SceneBudget(uint64_t primitives = limits::kMaxPrimitivesMade)
      : allowed_(primitives), left_(primitives) {}

  // To be called before they are made. Throws Error (kBadInput), without a place.
  void Spend(uint64_t primitives) {
    if (primitives > left_) {
      throw Error(ExitCode::kBadInput, {},
                  fmt::format("the scene would have more than {} spheres and triangles", allowed_),
                  "ask for fewer");
    }
    left_ -= primitives;
  }

  // False from the second time on: a scene has one environment, whose picture may be large.
  bool TakeSkyPicture() {
    const bool first = !has_sky_picture_;
    has_sky_picture_ = true;
    return first;
  }

 private:
  uint64_t allowed_, left_;
  bool has_sky_picture_ = false;
};

}  // namespace nacre
