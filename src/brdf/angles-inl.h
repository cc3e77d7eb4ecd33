// SPDX-License-Identifier: Apache-2.0
// brdf/angles-inl.h: angles for reflection models on SIMD vectors. Scalar twin: brdf/angles.h.
#if defined(NACRE_BRDF_ANGLES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_BRDF_ANGLES_INL_H_
#undef NACRE_BRDF_ANGLES_INL_H_
#else
#define NACRE_BRDF_ANGLES_INL_H_
#endif

#include <limits>

#include "base/vec3-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class V>
HWY_INLINE Vec3V<V> Mirrored(const Vec3V<V>& v, const Vec3V<V>& m) {
  const V along = FusedDot(m, v);
  const V twice = hn::Add(along, along);
  return {hn::MulSub(m.x, twice, v.x), hn::MulSub(m.y, twice, v.y), hn::MulSub(m.z, twice, v.z)};
}

// |n x u|^2 is computed as |u - n (n.u)|^2: one fused operation for each component, and the errors
// of |n| and n.u are along n, where their effect is of second order.
template <class V>
struct HalfAnglesV {
  V n_dot_u, u_squared, nxu_squared, lv_squared;
};

// Selects one of two sets of angles in each lane. All members are selected, because the two sets
// are rounded differently, and a lane that mixed them would have other bits than either.
template <class M, class V>
HWY_INLINE HalfAnglesV<V> Choose(const M& mask, const HalfAnglesV<V>& yes,
                                 const HalfAnglesV<V>& no) {
  return {hn::IfThenElse(mask, yes.n_dot_u, no.n_dot_u),
          hn::IfThenElse(mask, yes.u_squared, no.u_squared),
          hn::IfThenElse(mask, yes.nxu_squared, no.nxu_squared),
          hn::IfThenElse(mask, yes.lv_squared, no.lv_squared)};
}

template <class V>
struct AnglesV : HalfAnglesV<V> {
  V n_dot_l, n_dot_v;
};

// |a|^2 plus the smallest normal number, so that the result is at least that. Sums above 1e7 times
// it do not change.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V SquaredLength(D d, const Vec3V<V>& a) {
  const V smallest = hn::Set(d, std::numeric_limits<hn::TFromD<D>>::min());
  return hn::MulAdd(a.z, a.z, hn::MulAdd(a.y, a.y, hn::MulAdd(a.x, a.x, smallest)));
}

// |u|^2 from the components of u along n and across it: two operations fewer, and at the peak of a
// lobe the error of |n| cancels against that of n.u.
template <class V>
HWY_INLINE V USquared(V n_dot_u, V nxu_squared) {
  return hn::MulAdd(n_dot_u, n_dot_u, nxu_squared);
}

// The angles for a given vector u along h.
template <class D, class V = hn::Vec<D>>
HWY_INLINE HalfAnglesV<V> HalfAnglesOf(D d, const Vec3V<V>& n, const Vec3V<V>& u, V n_dot_u,
                                       const Vec3V<V>& l_minus_v) {
  const Vec3V<V> across{hn::NegMulAdd(n.x, n_dot_u, u.x), hn::NegMulAdd(n.y, n_dot_u, u.y),
                        hn::NegMulAdd(n.z, n_dot_u, u.z)};
  const V across_squared = SquaredLength(d, across);
  return {n_dot_u, USquared(n_dot_u, across_squared), across_squared,
          FusedDot(l_minus_v, l_minus_v)};
}

// u = l + v without its component along l - v, as the scalar twin explains.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Vec3V<V> HalfSum(D d, const Vec3V<V>& l, const Vec3V<V>& v, const Vec3V<V>& l_minus_v) {
  const Vec3V<V> sum = Add(l, v);
  const V along = hn::Mul(FusedDot(sum, l_minus_v), hn::Set(d, hn::TFromD<D>(0.25)));
  return {hn::NegMulAdd(l_minus_v.x, along, sum.x), hn::NegMulAdd(l_minus_v.y, along, sum.y),
          hn::NegMulAdd(l_minus_v.z, along, sum.z)};
}

// The angles of that u.
template <class D, class V = hn::Vec<D>>
HWY_INLINE HalfAnglesV<V> ComputeHalfAngles(D d, const Vec3V<V>& n, const Vec3V<V>& l,
                                            const Vec3V<V>& v) {
  const Vec3V<V> l_minus_v = Sub(l, v);
  const Vec3V<V> u = HalfSum(d, l, v, l_minus_v);
  return HalfAnglesOf(d, n, u, FusedDot(n, u), l_minus_v);
}

// UprightHalfAngles takes u = l + v without that correction, which saves ten operations, and n.u as
// n.l + n.v, because the error of this is a vector along n. The result is as accurate as that of
// ComputeHalfAngles where its u_squared >= kUprightUSquared, that is, where light and viewer are at
// most 150 degrees apart: |l|^2 and |v|^2 differ by rounding errors, and u is tilted by a quarter
// of the difference times |l - v| / |u|, which is at most 4.
constexpr float kUprightUSquared = 0.25f;

template <class D, class V = hn::Vec<D>>
HWY_INLINE hn::Mask<D> IsUpright(D d, const HalfAnglesV<V>& a) {
  return hn::Ge(a.u_squared, hn::Set(d, kUprightUSquared));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE HalfAnglesV<V> UprightHalfAngles(D d, const Vec3V<V>& n, const Vec3V<V>& u,
                                            const Vec3V<V>& l_minus_v, V n_dot_l, V n_dot_v) {
  return HalfAnglesOf(d, n, u, hn::Add(n_dot_l, n_dot_v), l_minus_v);
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE AnglesV<V> ComputeAngles(D d, const Vec3V<V>& n, const Vec3V<V>& l, const Vec3V<V>& v) {
  return {ComputeHalfAngles(d, n, l, v), FusedDot(n, l), FusedDot(n, v)};
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V LightDotView(D d, const HalfAnglesV<V>& a) {
  return hn::Mul(hn::Sub(a.u_squared, a.lv_squared), hn::Set(d, hn::TFromD<D>(0.25)));
}

}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
