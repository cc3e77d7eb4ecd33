// SPDX-License-Identifier: Apache-2.0
// base/highway_targets.cc: the Highway targets that this processor supports. Replaces three
// functions of libhwy, so that nacre need not be linked with it: a static initialiser of libhwy
// measures the clock for 4 ms at every start of a program.
#include "hwy/highway.h"

#if HWY_ARCH_X86
#include <cpuid.h>
#endif

namespace hwy {
namespace {

#if HWY_ARCH_X86
// F16C and LZCNT, which Clang 14's __builtin_cpu_supports does not know.
bool HasHalfAndZeroCount() {
  unsigned a = 0, b = 0, c = 0, d = 0;
  const bool f16c = __get_cpuid(1, &a, &b, &c, &d) != 0 && (c & bit_F16C) != 0;
  return f16c && __get_cpuid(0x80000001u, &a, &b, &c, &d) != 0 && (c & bit_LZCNT) != 0;
}
#endif

int64_t DetectTargets() {
  int64_t targets = HWY_SCALAR;
#if HWY_ARCH_X86
  __builtin_cpu_init();
  const auto has = [](auto... features) { return (features && ...); };
  const bool sse4 = has(__builtin_cpu_supports("ssse3"), __builtin_cpu_supports("sse4.1"),
                        __builtin_cpu_supports("sse4.2"), __builtin_cpu_supports("pclmul"),
                        __builtin_cpu_supports("aes"));
  const bool avx2 = sse4 && has(__builtin_cpu_supports("avx"), __builtin_cpu_supports("avx2"),
                                __builtin_cpu_supports("fma"), __builtin_cpu_supports("bmi"),
                                __builtin_cpu_supports("bmi2"), HasHalfAndZeroCount());
  const bool avx3 =
      avx2 && has(__builtin_cpu_supports("avx512f"), __builtin_cpu_supports("avx512cd"),
                  __builtin_cpu_supports("avx512vl"), __builtin_cpu_supports("avx512dq"),
                  __builtin_cpu_supports("avx512bw"));
  if (sse4) targets |= HWY_SSE4;
  if (avx2) targets |= HWY_AVX2;
  if (avx3) targets |= HWY_AVX3;
#else
  targets |= HWY_STATIC_TARGET;  // the target of this compilation
#endif
  return targets;
}

// The targets that SetSupportedTargetsForTest has set; 0: none.
int64_t& Pinned() {
  static int64_t pinned = 0;
  return pinned;
}

}  // namespace

ChosenTarget& GetChosenTarget() {
  static ChosenTarget chosen;
  return chosen;
}

int64_t SupportedTargets() {
  static const int64_t detected = DetectTargets();
  return Pinned() != 0 ? Pinned() : detected;
}

void SetSupportedTargetsForTest(int64_t targets) { Pinned() = targets; }

}  // namespace hwy
