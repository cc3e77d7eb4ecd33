// SPDX-License-Identifier: Apache-2.0
#include "base/target.h"

#include <optional>

#include "hwy/highway.h"

namespace nacre {
namespace {

constexpr Target kAllTargets[] = {Target::kScalar, Target::kSse4, Target::kAvx2, Target::kAvx3,
                                  Target::kNeon};

int64_t HighwayTarget(Target target) {
  switch (target) {
    case Target::kScalar:
      return HWY_TARGETS & HWY_SCALAR;
    case Target::kSse4:
      return HWY_SSE4;
    case Target::kAvx2:
      return HWY_AVX2;
    case Target::kAvx3:
      return HWY_AVX3;
    case Target::kNeon:
      return HWY_ARCH_ARM ? HWY_STATIC_TARGET : 0;
  }
  return 0;
}

}  // namespace

std::string TargetName(Target target) {
  switch (target) {
    case Target::kScalar:
      return "scalar";
    case Target::kSse4:
      return "sse4";
    case Target::kAvx2:
      return "avx2";
    case Target::kAvx3:
      return "avx3";
    case Target::kNeon:
      return "neon";
  }
  return {};
}

std::vector<Target> SupportedTargets() {
  // Queried once, before any target is pinned: afterwards Highway returns the pinned one.
  static const int64_t supported = (hwy::SupportedTargets() | HWY_SCALAR) & HWY_TARGETS;
  std::vector<Target> targets;
  for (const Target target : kAllTargets) {
    if ((supported & HighwayTarget(target)) != 0) targets.push_back(target);
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
  hwy::SetSupportedTargetsForTest(HighwayTarget(target));
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  PinnedTarget() = target;
}

Target ActiveTarget() { return PinnedTarget().value_or(SupportedTargets().back()); }

}  // namespace nacre
