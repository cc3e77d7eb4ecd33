// SPDX-License-Identifier: Apache-2.0
// hit/shading_normal-inl.h: clamps view directions and bends normal-mapped normals, on SIMD
// vectors. Scalar twin: hit/shading_normal.h.
#if defined(NACRE_HIT_SHADING_NORMAL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_HIT_SHADING_NORMAL_INL_H_
#undef NACRE_HIT_SHADING_NORMAL_INL_H_
#else
#define NACRE_HIT_SHADING_NORMAL_INL_H_
#endif

#include "base/vec3-inl.h"
#include "hit/shading_normal.h"

HWY_BEFORE_NAMESPACE();
namespace nacre::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class D, class V = hn::Vec<D>>
HWY_INLINE Vec3V<V> GrazingView(D d, const Vec3V<V>& normal, const Vec3V<V>& to_view) {
  const V least = hn::Set(d, kMinViewCosine);
  const V n_dot_v = Dot(normal, to_view);
  const Vec3V<V> across = Sub(to_view, Scale(normal, hn::Sub(n_dot_v, least)));
  const V inverse = hn::Div(hn::Set(d, 1.0), hn::Sqrt(Dot(across, across)));
  return Select(hn::Ge(n_dot_v, least), to_view, Scale(across, inverse));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE Vec3V<V> BendNormal(D d, const Vec3V<V>& normal, const Vec3V<V>& surface,
                               const Vec3V<V>& to_view) {
  const V zero = hn::Zero(d), one = hn::Set(d, 1.0);
  const auto unit = [&](const Vec3V<V>& v)
                        HWY_ATTR { return Scale(v, hn::Div(one, hn::Sqrt(Dot(v, v)))); };
  const V n_dot_v = Dot(normal, to_view);
  const Vec3V<V> mirrored = Sub(Scale(normal, hn::Add(n_dot_v, n_dot_v)), to_view);
  const V height = Dot(mirrored, surface);
  const auto bends = hn::Or(hn::Lt(height, zero), hn::Lt(n_dot_v, zero));
  if (hn::AllFalse(d, bends)) return normal;
  const Vec3V<V> projected = Sub(mirrored, Scale(surface, height));
  const Vec3V<V> leaning = Sub(normal, Scale(surface, Dot(normal, surface)));
  const auto straight_down = hn::Lt(Dot(projected, projected), hn::Set(d, 0x1p-60));
  const Vec3V<V> along = unit(Select(straight_down, leaning, projected));
  const Vec3V<V> bent = unit(Add(to_view, along));
  const auto is_half = hn::Ge(Dot(bent, to_view), zero);
  return Select(bends, Select(is_half, bent, surface), normal);
}

}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
