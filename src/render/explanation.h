// SPDX-License-Identifier: Apache-2.0
// render/explanation.h: why a frame is rendered as it is, which `--explain` prints.
#pragma once

#include <string>
#include <vector>

namespace nacre {

// A decision and its reason. Skipping work leaves every bit as in the general path.
struct PlanItem {
  std::string what;  // "light \"key\" shadow rays"
  bool used = false;
  std::string reason;  // "a sphere alone, seen from outside, is convex"
};

// Each stage's plan adds its decisions.
struct Explanation {
  std::vector<PlanItem> items;
  // Methods whose results agree with the general path within a stated error, not bit by bit.
  std::vector<PlanItem> substitutions;
  std::vector<std::string> notes;  // remarks on the scene (plan_notes.h)
};

}  // namespace nacre
