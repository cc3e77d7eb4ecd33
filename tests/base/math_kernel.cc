// SPDX-License-Identifier: Apache-2.0
// tests/base/math_kernel.cc: the calls behind math_kernel.h.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "base/math_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "base/math-inl.h"
#include "base/math_kernel.h"
#include "base/target_ops-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {

using FloatTag = hn::ScalableTag<float>;

float EvaluateLog2T(float x) {
  const FloatTag d;
  return hn::GetLane(Log2(d, hn::Set(d, x)));
}

float EvaluateLog2OneMinusT(float x, float c) {
  const FloatTag d;
  return hn::GetLane(Log2OneMinus(d, hn::Set(d, x), hn::Set(d, c)));
}

float EvaluateExp2T(float y) {
  const FloatTag d;
  return hn::GetLane(Exp2(d, hn::Set(d, y)));
}

TargetOps EvaluateTargetOpsT(const std::vector<float>& x) {
  const FloatTag d;
  TargetOps ops;
  for (const float number : x) {
    const auto v = hn::Set(d, number);
    ops.reciprocal.push_back(hn::GetLane(Reciprocal(d, v)));
    ops.reciprocal_sqrt.push_back(hn::GetLane(ReciprocalSqrt(d, v)));
    ops.square_root.push_back(hn::GetLane(SquareRoot(d, v)));
    ops.twice_square_root.push_back(hn::GetLane(TwiceSquareRoot(d, v)));
  }
  return ops;
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(EvaluateLog2T);
HWY_EXPORT(EvaluateLog2OneMinusT);
HWY_EXPORT(EvaluateExp2T);
HWY_EXPORT(EvaluateTargetOpsT);

float EvaluateLog2(float x) { return HWY_DYNAMIC_DISPATCH(EvaluateLog2T)(x); }
float EvaluateLog2OneMinus(float x, float c) {
  return HWY_DYNAMIC_DISPATCH(EvaluateLog2OneMinusT)(x, c);
}
float EvaluateExp2(float y) { return HWY_DYNAMIC_DISPATCH(EvaluateExp2T)(y); }
TargetOps EvaluateTargetOps(const std::vector<float>& x) {
  return HWY_DYNAMIC_DISPATCH(EvaluateTargetOpsT)(x);
}
}  // namespace nacre
#endif
