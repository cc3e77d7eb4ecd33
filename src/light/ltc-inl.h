// SPDX-License-Identifier: Apache-2.0
// light/ltc-inl.h: the frames and matrices of linearly transformed cosines on SIMD vectors, of
// floats or doubles. Scalar: ltc.h.
#if defined(NACRE_LIGHT_LTC_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_LIGHT_LTC_INL_H_
#undef NACRE_LIGHT_LTC_INL_H_
#else
#define NACRE_LIGHT_LTC_INL_H_
#endif

#include "light/area_sample-inl.h"
#include "light/ltc.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// The matrices of hits.
template <class V>
struct MatrixV {
  V xx, xz, zx, zz;

  HWY_INLINE Vec3V<V> Map(const Vec3V<V>& v) const {
    return {hn::MulAdd(xx, v.x, hn::Mul(xz, v.z)), v.y, hn::MulAdd(zx, v.x, hn::Mul(zz, v.z))};
  }
};

template <class D, class V = hn::Vec<D>>
HWY_INLINE MatrixV<V> MatrixAt(D d, const LtcRow& row, const hn::TFromD<D>* cosines) {
  alignas(64) hn::TFromD<D> numbers[4][64 / sizeof(hn::TFromD<D>)];
  for (size_t k = 0; k < hn::Lanes(d); ++k) {
    const LtcNumbers at = AtView(row, static_cast<float>(cosines[k]));
    numbers[0][k] = at.xx;
    numbers[1][k] = at.xz;
    numbers[2][k] = at.zx;
    numbers[3][k] = at.zz;
  }
  return {hn::Load(d, numbers[0]), hn::Load(d, numbers[1]), hn::Load(d, numbers[2]),
          hn::Load(d, numbers[3])};
}

// The frame of hits, and the matrices of their views, for both parts of the lobe.
template <class V>
struct LobeFrameV {
  Vec3V<V> x, y, normal;
  MatrixV<V> one, schlick;

  HWY_INLINE Vec3V<V> ToLocal(const Vec3V<V>& v) const {
    return {FusedDot(x, v), FusedDot(y, v), FusedDot(normal, v)};
  }
};

// Views along the normal have any x: their matrices are round.
template <class D, class V = hn::Vec<D>>
HWY_INLINE LobeFrameV<V> FrameAt(D d, const LtcRows& rows, const Vec3V<V>& n,
                                 const Vec3V<V>& view) {
  using T = hn::TFromD<D>;
  LobeFrameV<V> frame;
  frame.normal = n;
  const V n_dot_v = FusedDot(n, view);
  const V zero = hn::Zero(d), one = hn::Set(d, T(1));
  const auto steep = hn::Gt(hn::Abs(n.x), hn::Set(d, T(0.7)));
  const Vec3V<V> other{hn::IfThenElse(steep, zero, one), hn::IfThenElse(steep, one, zero), zero};
  const Vec3V<V> across = AddScaled(view, n, hn::Neg(n_dot_v));
  const Vec3V<V> any = AddScaled(other, n, hn::Neg(FusedDot(n, other)));
  const auto has_side = hn::Gt(FusedDot(across, across), hn::Set(d, T(1e-10)));
  const Vec3V<V> chosen = Select(has_side, across, any);
  frame.x = Scale(chosen, hn::Div(one, Length(chosen)));
  frame.y = FusedCross(n, frame.x);
  alignas(64) T cosines[64 / sizeof(T)];
  hn::Store(n_dot_v, d, cosines);
  frame.one = MatrixAt(d, rows.one, cosines);
  frame.schlick = MatrixAt(d, rows.schlick, cosines);
  return frame;
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
