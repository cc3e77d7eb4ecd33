// SPDX-License-Identifier: Apache-2.0
#include "base/target.h"

#include <iterator>
#include <optional>

#include "hwy/highway.h"

namespace nacre {
namespace {

struct TargetRow {
  const char* name;
  int64_t highway;  // Highway's bit; 0: not on this architecture
};

// By Target, slowest first.
constexpr TargetRow kTargets[] = {
    {"scalar", HWY_TARGETS& HWY_SCALAR},
    {"sse4", HWY_SSE4},
    {"avx2", HWY_AVX2},
    {"avx3", HWY_AVX3},
    {"neon", HWY_ARCH_ARM ? HWY_STATIC_TARGET : 0},
};

const TargetRow& RowOf(Target target) { return kTargets[static_cast<size_t>(target)]; }

}  // namespace

std::string TargetName(Target target) { return RowOf(target).name; }

std::vector<Target> SupportedTargets() {
  // Queried once, before any target is pinned: afterwards Highway returns the pinned one.
  static const int64_t supported = (hwy::SupportedTargets() | HWY_SCALAR) & HWY_TARGETS;
  std::vector<Target> targets;
  for (size_t i = 0; i < std::size(kTargets); ++i) {
    if ((supported & kTargets[i].highway) != 0) targets.push_back(static_cast<Target>(i));
  }
  return targets;
}

// Highway's choice of target is process-wide, so its record here is too.
static std::optional<Target>& PinnedTarget() {
  static std::optional<Target> pinned;
  return pinned;
}

void PinTarget(Target target) {
  SupportedTargets();
  hwy::SetSupportedTargetsForTest(RowOf(target).highway);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  PinnedTarget() = target;
}

Target ActiveTarget() { return PinnedTarget().value_or(SupportedTargets().back()); }

}  // namespace nacre
