// SPDX-License-Identifier: Apache-2.0
// render/explanation.h: why a frame is rendered the way it is: what `--explain` prints.
#pragma once

#include <string>
#include <vector>

namespace nacre {

// A decision and its reason. Skipping leaves every bit as the general path would make it.
struct PlanItem {
  std::string what;  // "light \"key\" shadow rays"
  bool used = false;
  std::string reason;  // "a sphere alone, seen from outside, is convex"
};

// Each stage's plan adds its own decisions.
struct Explanation {
  std::vector<PlanItem> items;
  std::vector<PlanItem> substitutions;  // choices that agree within a stated error, not to the bit
  std::vector<std::string> notes;       // what the picture cannot show, and why
};

}  // namespace nacre
