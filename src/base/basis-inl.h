// SPDX-License-Identifier: Apache-2.0
// base/basis-inl.h: orthonormal bases on SIMD vectors. Scalar twin: base/basis.h.
#if defined(NACRE_BASE_BASIS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_BASE_BASIS_INL_H_
#undef NACRE_BASE_BASIS_INL_H_
#else
#define NACRE_BASE_BASIS_INL_H_
#endif

#include "base/vec3-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class V>
struct BasisV {
  Vec3V<V> x, y, z;
};

// Duff et al. 2017.
template <class D, class V = hn::Vec<D>>
HWY_INLINE BasisV<V> BasisAbout(D d, const Vec3V<V>& z) {
  const V one = hn::Set(d, hn::TFromD<D>(1));
  const V sign = hn::IfThenElse(hn::Lt(z.z, hn::Zero(d)), hn::Neg(one), one);
  const V a = hn::Neg(hn::Div(one, hn::Add(sign, z.z)));
  const V b = hn::Mul(hn::Mul(z.x, z.y), a);
  const V signed_x = hn::Mul(sign, z.x);
  return {{hn::MulAdd(hn::Mul(signed_x, z.x), a, one), hn::Mul(sign, b), hn::Neg(signed_x)},
          {b, hn::MulAdd(hn::Mul(z.y, z.y), a, sign), hn::Neg(z.y)},
          z};
}

template <class V>
HWY_INLINE Vec3V<V> ToWorld(const BasisV<V>& basis, const Vec3V<V>& local) {
  const auto mix = [&](V x, V y, V z) {
    return hn::MulAdd(z, local.z, hn::MulAdd(y, local.y, hn::Mul(x, local.x)));
  };
  return {mix(basis.x.x, basis.y.x, basis.z.x), mix(basis.x.y, basis.y.y, basis.z.y),
          mix(basis.x.z, basis.y.z, basis.z.z)};
}

template <class V>
HWY_INLINE Vec3V<V> ToLocal(const BasisV<V>& basis, const Vec3V<V>& world) {
  return {FusedDot(basis.x, world), FusedDot(basis.y, world), FusedDot(basis.z, world)};
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
