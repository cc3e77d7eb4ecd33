// SPDX-License-Identifier: Apache-2.0
// brdf/phong-inl.h: the lobes of the Phong family on SIMD vectors. Scalar twin: brdf/phong.h.
#if defined(NACRE_BRDF_PHONG_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_BRDF_PHONG_INL_H_
#undef NACRE_BRDF_PHONG_INL_H_
#else
#define NACRE_BRDF_PHONG_INL_H_
#endif

#include "base/math-inl.h"
#include "base/target_ops-inl.h"
#include "brdf/angles-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// A lobe's cosine c, and 1 - c, computed without cancellation.
template <class V>
struct LobeCosineV {
  V one_minus_c, c;
};

// Replaces log2(0). Its product with any exponent of at least 2^-88 is below the logarithm of every
// float, its product with limits::kExponent is finite, and its product with 0 is 0, so that c^0 is
// 1 at c = 0, too.
inline constexpr float kDarkLog2 = -0x1p96f;

// log2(c), kDarkLog2 where c <= 0.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V LobeLog2(D d, const LobeCosineV<V>& cosine) {
  const V log2 = Log2OneMinus(d, cosine.one_minus_c, cosine.c);
  const V dark = hn::Set(d, kDarkLog2);
  // If kSplitsFloats, it is known what Log2OneMinus returns where c <= 0, and one operation is
  // enough: the maximum of NaN and a number is the number, which is the second operand.
  if constexpr (kSplitsFloats<V>) return hn::Max(log2, dark);
  return hn::IfThenElse(hn::Gt(cosine.c, hn::Zero(d)), log2, dark);
}

// |r - v|^2, where r is the mirror direction of the light.
template <class V>
HWY_INLINE V SquaredFromReflection(const Vec3V<V>& normal, const Vec3V<V>& to_light,
                                   const Vec3V<V>& to_view) {
  const Vec3V<V> r_minus_v = Sub(Mirrored(to_light, normal), to_view);
  return FusedDot(r_minus_v, r_minus_v);
}

// |r - v|^2 for l = offset inverse_length, in a dependency chain that does not wait for l.
template <class V>
HWY_INLINE V SquaredFromReflection(const Vec3V<V>& normal, const Vec3V<V>& offset, V inverse_length,
                                   const Vec3V<V>& to_view) {
  const Vec3V<V> r_minus_v = MulSub3(Mirrored(offset, normal), inverse_length, to_view);
  return FusedDot(r_minus_v, r_minus_v);
}

// r.v, computed from |r - v|^2 as the scalar twin explains.
template <class D, class V = hn::Vec<D>>
HWY_INLINE LobeCosineV<V> PhongCosine(D d, V squared_from_reflection) {
  const V one_minus_c = hn::Mul(squared_from_reflection, hn::Set(d, hn::TFromD<D>(0.5)));
  return {one_minus_c, hn::Sub(hn::Set(d, hn::TFromD<D>(1)), one_minus_c)};
}

// (n.h)^2. Blinn's lobe is this to the power of n/2.
template <class D, class V = hn::Vec<D>>
HWY_INLINE LobeCosineV<V> BlinnSquaredCosine(D d, const HalfAnglesV<V>& a) {
  // |u|^2 is a normal number.
  const V scale = Reciprocal(d, a.u_squared);
  const V cos2 = hn::Mul(hn::Mul(a.n_dot_u, a.n_dot_u), scale);
  // Lanes whose half vector is below the surface get cos^2 = 0, where the lobe is 0.
  const auto above = hn::Gt(a.n_dot_u, hn::Zero(d));
  return {hn::Mul(a.nxu_squared, scale), hn::IfThenElseZero(above, cos2)};
}

// c^n from log2(c): 0 where c <= 0, but 1 everywhere for n = 0.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V LobePower(D d, V log2, V n) {
  return HWY_NAMESPACE::Exp2(d, hn::Mul(n, log2));
}

// (n.h)^n from log2((n.h)^2).
template <class D, class V = hn::Vec<D>>
HWY_INLINE V LobePowerOfSquare(D d, V log2, V n) {
  return LobePower(d, log2, hn::Mul(n, hn::Set(d, 0.5f)));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V PhongLobe(D d, const LobeCosineV<V>& cosine, V shininess) {
  return LobePower(d, LobeLog2(d, cosine), shininess);
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V BlinnLobe(D d, const LobeCosineV<V>& squared_cosine, V shininess) {
  return LobePowerOfSquare(d, LobeLog2(d, squared_cosine), shininess);
}

}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
