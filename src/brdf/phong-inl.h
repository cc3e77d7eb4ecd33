// SPDX-License-Identifier: Apache-2.0
// brdf/phong-inl.h: the lobes of the Phong family on SIMD vectors. Scalar twin: brdf/phong.h.
#if defined(NACRE_BRDF_PHONG_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_BRDF_PHONG_INL_H_
#undef NACRE_BRDF_PHONG_INL_H_
#else
#define NACRE_BRDF_PHONG_INL_H_
#endif

#include <limits>

#include "base/math-inl.h"
#include "base/target_ops-inl.h"
#include "brdf/angles-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// c^n for c = 1 - x; 0 where c <= 0, but 1 everywhere for n = 0.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V LobePower(D d, V x, V c, V n) {
  // The logarithm of 0 as the lowest float: times any n > 0 it is far below what has a power of 2,
  // and times 0 it is 0. What Log2OneMinus makes of c <= 0 is finite.
  const V lowest = hn::Set(d, std::numeric_limits<float>::lowest());
  const V log2 = hn::IfThenElse(hn::Gt(c, hn::Zero(d)), Log2OneMinus(d, x, c), lowest);
  return Exp2(d, hn::Mul(n, log2));
}

// A lobe's cosine c, and 1 - c free of cancellation.
template <class V>
struct LobeCosineV {
  V one_minus_c, c;
};

// r.v, r the reflection of the light, without r and its roundings: the scalar twin tells how.
template <class D, class V = hn::Vec<D>>
HWY_INLINE LobeCosineV<V> PhongCosine(D d, const Vec3V<V>& normal, const Vec3V<V>& to_light,
                                      const Vec3V<V>& to_view, V n_dot_l, V n_dot_v) {
  const Vec3V<V> u = Add(to_light, to_view);
  const V along = hn::Sub(n_dot_l, n_dot_v);
  const V n_dot_u = hn::Add(n_dot_l, n_dot_v);
  const Vec3V<V> across{hn::NegMulAdd(normal.x, n_dot_u, u.x),
                        hn::NegMulAdd(normal.y, n_dot_u, u.y),
                        hn::NegMulAdd(normal.z, n_dot_u, u.z)};
  const V squared = hn::MulAdd(along, along, FusedDot(across, across));
  const V one_minus_c = hn::Mul(squared, hn::Set(d, hn::TFromD<D>(0.5)));
  return {one_minus_c, hn::Sub(hn::Set(d, hn::TFromD<D>(1)), one_minus_c)};
}

// (n.h)^2, of which Blinn's lobe is the power n/2.
template <class D, class V = hn::Vec<D>>
HWY_INLINE LobeCosineV<V> BlinnSquaredCosine(D d, V n_dot_u, V nxu_squared) {
  const V zero = hn::Zero(d);
  const V one = hn::Set(d, hn::TFromD<D>(1));
  const V cos2 = hn::Mul(n_dot_u, n_dot_u);
  const V u_squared = hn::Add(cos2, nxu_squared);
  const auto above = hn::And(hn::Gt(n_dot_u, zero), hn::Gt(u_squared, zero));
  const V scale = Reciprocal(d, hn::IfThenElse(above, u_squared, one));
  // Lanes below the surface get cos^2 = 0, the lobe's zero.
  return {hn::Mul(nxu_squared, scale), hn::IfThenElseZero(above, hn::Mul(cos2, scale))};
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE LobeCosineV<V> BlinnSquaredCosine(D d, const HalfAnglesV<V>& a) {
  return BlinnSquaredCosine(d, a.n_dot_u, a.nxu_squared);
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V PhongLobe(D d, const LobeCosineV<V>& cosine, V shininess) {
  return LobePower(d, cosine.one_minus_c, cosine.c, shininess);
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V BlinnLobe(D d, const LobeCosineV<V>& squared_cosine, V shininess) {
  return LobePower(d, squared_cosine.one_minus_c, squared_cosine.c,
                   hn::Mul(shininess, hn::Set(d, 0.5f)));
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
