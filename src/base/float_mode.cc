// SPDX-License-Identifier: Apache-2.0
#include "base/float_mode.h"

#if defined(__SSE2__)
#include <xmmintrin.h>
#elif !defined(__aarch64__)
#include <cfenv>
#endif

namespace nacre {

// The registers are accessed directly: <cfenv> has no modes for denormals, and its functions take
// hundreds of cycles, which is noticeable in calls as short as Brdf::Evaluate.
#if defined(__SSE2__)
namespace {

constexpr uint32_t kFlushToZero = 0x8000, kDenormalsAreZero = 0x0040;
constexpr uint32_t kDefaultMxcsr = 0x1f80;  // rounding to nearest, all exceptions masked
// The same for the x87, with 64-bit mantissas: the C library reads the rounding mode from it.
constexpr uint16_t kDefaultControl = 0x037f;

uint16_t ReadControl() {
  uint16_t control = 0;
  asm volatile("fnstcw %0" : "=m"(control));
  return control;
}

void WriteControl(uint16_t control) {
  if (ReadControl() != control) asm volatile("fldcw %0" : : "m"(control));
}

}  // namespace

uint64_t EnterFloatMode(Denormals denormals) {
  const uint64_t before = uint64_t{ReadControl()} << 32 | _mm_getcsr();
  WriteControl(kDefaultControl);
  const bool flush = denormals == Denormals::kFlushed;
  _mm_setcsr(flush ? kDefaultMxcsr | kFlushToZero | kDenormalsAreZero : kDefaultMxcsr);
  return before;
}

void LeaveFloatMode(uint64_t before) {
  _mm_setcsr(static_cast<uint32_t>(before));
  WriteControl(static_cast<uint16_t>(before >> 32));
}
#elif defined(__aarch64__)
uint64_t EnterFloatMode(Denormals denormals) {
  constexpr uint64_t kFlushToZero = uint64_t{1} << 24;
  uint64_t before = 0;
  asm volatile("mrs %0, fpcr" : "=r"(before));
  asm volatile("msr fpcr, %0" : : "r"(denormals == Denormals::kFlushed ? kFlushToZero : 0));
  return before;
}

void LeaveFloatMode(uint64_t before) { asm volatile("msr fpcr, %0" : : "r"(before)); }
#else
uint64_t EnterFloatMode(Denormals) {
  const int before = std::fegetround();
  std::fesetround(FE_TONEAREST);
  return static_cast<uint64_t>(before);
}

void LeaveFloatMode(uint64_t before) { std::fesetround(static_cast<int>(before)); }
#endif

}  // namespace nacre
