// SPDX-License-Identifier: Apache-2.0
// base/concentric_disk-inl.h: square to disk on SIMD vectors. Scalar twin: base/concentric_disk.h.
#if defined(NACRE_BASE_CONCENTRIC_DISK_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_BASE_CONCENTRIC_DISK_INL_H_
#undef NACRE_BASE_CONCENTRIC_DISK_INL_H_
#else
#define NACRE_BASE_CONCENTRIC_DISK_INL_H_
#endif

#include "base/trig-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class V>
struct PointOnDiskV {
  V x, y, radius;
};

// Shirley and Chiu 1997: angles are at most an eighth of a turn, plus a quarter.
template <class D, class V = hn::Vec<D>>
HWY_INLINE PointOnDiskV<V> ConcentricDisk(D d, V u0, V u1) {
  const V zero = hn::Zero(d);
  const V one = hn::Set(d, 1.0f);
  const V two = hn::Set(d, 2.0f);
  const V a = hn::MulSub(two, u0, one), b = hn::MulSub(two, u1, one);
  const auto flat = hn::Gt(hn::Abs(a), hn::Abs(b));
  const V larger = hn::IfThenElse(flat, a, b), smaller = hn::IfThenElse(flat, b, a);
  const V ratio = hn::Div(smaller, hn::IfThenElse(hn::Eq(larger, zero), one, larger));
  const SinCosV<V> phi = SinCosTurns(d, hn::Mul(ratio, hn::Set(d, 0.125f)));
  return {hn::Mul(larger, hn::IfThenElse(flat, phi.cos, phi.sin)),
          hn::Mul(larger, hn::IfThenElse(flat, phi.sin, phi.cos)), hn::Abs(larger)};
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
