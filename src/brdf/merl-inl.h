// SPDX-License-Identifier: Apache-2.0
// brdf/merl-inl.h: MERL tables looked up on SIMD vectors, by gathers. Scalar twin: brdf/merl.h,
// which has the derivation.
#if defined(NACRE_BRDF_MERL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_BRDF_MERL_INL_H_
#undef NACRE_BRDF_MERL_INL_H_
#else
#define NACRE_BRDF_MERL_INL_H_
#endif

#include "base/trig-inl.h"
#include "brdf/angles-inl.h"
#include "brdf/measured_table.h"
#include "brdf/tabulated_warp-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class V>
struct MerlCoordinatesV {
  V half, diff, phi;
};

template <class D, class V = hn::Vec<D>>
HWY_INLINE MerlCoordinatesV<V> ComputeMerlCoordinates(D d, const Vec3V<V>& n, const Vec3V<V>& l,
                                                      const Vec3V<V>& v) {
  const AnglesV<V> a = ComputeAngles(d, n, l, v);
  const V u = hn::Sqrt(a.u_squared);
  const V theta_half = Atan2Upper(d, hn::Sqrt(a.nxu_squared), a.n_dot_u);
  const V theta_diff = Atan2Upper(d, hn::Sqrt(a.lv_squared), u);
  // With the period pi, the point may be mirrored to where y is not below 0.
  const V triple = FusedDot(n, FusedCross(v, l));
  const V x = hn::Mul(u, hn::Sub(a.n_dot_v, a.n_dot_l));
  const V phi = Atan2Upper(d, hn::Abs(hn::Add(triple, triple)),
                           hn::IfThenElse(hn::Lt(triple, hn::Zero(d)), hn::Neg(x), x));
  const auto scaled = [&](size_t cells, V angle, double range) HWY_ATTR {
    return hn::Mul(angle, hn::Set(d, static_cast<float>(static_cast<double>(cells) / range)));
  };
  const V root = hn::Sqrt(hn::Mul(theta_half, hn::Set(d, static_cast<float>(M_2_PI))));
  return {hn::Mul(root, hn::Set(d, static_cast<float>(MerlTable::kThetaHalf))),
          scaled(MerlTable::kThetaDiff, theta_diff, M_PI_2),
          scaled(MerlTable::kPhiDiff, phi, M_PI)};
}

template <class D>
HWY_INLINE IndexV<D> MerlCell(D d, IndexV<D> half, IndexV<D> diff, IndexV<D> phi) {
  const IndexV<D> row = hn::Add(hn::Mul(half, SetIndex(d, MerlTable::kThetaDiff)), diff);
  return hn::Add(hn::Mul(row, SetIndex(d, MerlTable::kPhiDiff)), phi);
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE Vec3V<V> MerlValue(D d, const MerlTable& table, IndexV<D> cell) {
  const float* const rgb = table.rgb.data();
  const IndexV<D> at = hn::Mul(cell, SetIndex(d, 3));
  return {hn::GatherIndex(d, rgb, at), hn::GatherIndex(d, rgb + 1, at),
          hn::GatherIndex(d, rgb + 2, at)};
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE IndexV<D> MerlNearestCell(D d, const MerlCoordinatesV<V>& at) {
  return MerlCell(d, ToIndex(d, at.half, MerlTable::kThetaHalf - 1),
                  ToIndex(d, at.diff, MerlTable::kThetaDiff - 1),
                  ToIndex(d, at.phi, MerlTable::kPhiDiff - 1));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE Vec3V<V> MerlLinear(D d, const MerlTable& table, const MerlCoordinatesV<V>& at) {
  const V half_cell = hn::Set(d, 0.5f), zero = hn::Zero(d), one = hn::Set(d, 1.0f);
  const auto between = [&](V x, size_t count) HWY_ATTR {
    const V most = hn::Set(d, static_cast<float>(count - 1));
    const V centered = hn::Min(hn::Max(hn::Sub(x, half_cell), zero), most);
    const IndexV<D> i = ToIndex(d, centered, count - 2);
    return BetweenNodesV<D>{i, hn::Sub(centered, hn::ConvertTo(d, i))};
  };
  const BetweenNodesV<D> half = between(at.half, MerlTable::kThetaHalf);
  const BetweenNodesV<D> diff = between(at.diff, MerlTable::kThetaDiff);
  // In cells from the centre of the last one, whose number is the first of the sequence 179, 0, 1,
  // ..., 179.
  const IndexTag<D> di;
  const IndexV<D> one_cell = SetIndex(d, 1), last = SetIndex(d, MerlTable::kPhiDiff - 1);
  const V turned = hn::Add(at.phi, half_cell);
  const IndexV<D> number = ToIndex(d, turned, MerlTable::kPhiDiff);
  const V fraction = Clamp01(d, hn::Sub(turned, hn::ConvertTo(d, number)));
  const IndexV<D> first =
      hn::IfThenElse(hn::Eq(number, hn::Zero(di)), last, hn::Sub(number, one_cell));
  const IndexV<D> second = hn::IfThenElse(hn::Gt(number, last), hn::Zero(di), number);
  Vec3V<V> sum{zero, zero, zero};
  for (size_t i = 0; i < 2; ++i) {
    const V by_half = i == 0 ? hn::Sub(one, half.fraction) : half.fraction;
    for (size_t j = 0; j < 2; ++j) {
      const V by_diff = j == 0 ? hn::Sub(one, diff.fraction) : diff.fraction;
      const V weight = hn::Mul(by_half, by_diff);
      const IndexV<D> row_half = hn::Add(half.index, SetIndex(d, i));
      const IndexV<D> row_diff = hn::Add(diff.index, SetIndex(d, j));
      const Vec3V<V> a = MerlValue(d, table, MerlCell(d, row_half, row_diff, first));
      const Vec3V<V> b = MerlValue(d, table, MerlCell(d, row_half, row_diff, second));
      sum = MulAdd3(a, hn::Mul(weight, hn::Sub(one, fraction)), sum);
      sum = MulAdd3(b, hn::Mul(weight, fraction), sum);
    }
  }
  return sum;
}

}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
