// SPDX-License-Identifier: Apache-2.0
// tests/base/trig_kernel.cc: the calls behind trig_kernel.h.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "base/trig_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "base/trig-inl.h"
#include "base/trig_kernel.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {

using FloatTag = hn::ScalableTag<float>;

float EvaluateSinTurnsT(float u) {
  const FloatTag d;
  return hn::GetLane(SinCosTurns(d, hn::Set(d, u)).sin);
}

float EvaluateCosTurnsT(float u) {
  const FloatTag d;
  return hn::GetLane(SinCosTurns(d, hn::Set(d, u)).cos);
}

float EvaluateAtanRemainderT(float x) {
  const FloatTag d;
  return hn::GetLane(AtanRemainder(d, hn::Set(d, x)));
}

float EvaluateAtan2UpperT(float y, float x) {
  const FloatTag d;
  return hn::GetLane(Atan2Upper(d, hn::Set(d, y), hn::Set(d, x)));
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(EvaluateSinTurnsT);
HWY_EXPORT(EvaluateCosTurnsT);
HWY_EXPORT(EvaluateAtanRemainderT);
HWY_EXPORT(EvaluateAtan2UpperT);

float EvaluateSinTurns(float u) { return HWY_DYNAMIC_DISPATCH(EvaluateSinTurnsT)(u); }
float EvaluateCosTurns(float u) { return HWY_DYNAMIC_DISPATCH(EvaluateCosTurnsT)(u); }
float EvaluateAtanRemainder(float x) { return HWY_DYNAMIC_DISPATCH(EvaluateAtanRemainderT)(x); }
float EvaluateAtan2Upper(float y, float x) {
  return HWY_DYNAMIC_DISPATCH(EvaluateAtan2UpperT)(y, x);
}
}  // namespace nacre
#endif
