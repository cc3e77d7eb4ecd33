// SPDX-License-Identifier: Apache-2.0
// light/sky-inl.h: analytic skies on SIMD vectors. Scalar twin: sky.h.
#if defined(NACRE_LIGHT_SKY_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_LIGHT_SKY_INL_H_
#undef NACRE_LIGHT_SKY_INL_H_
#else
#define NACRE_LIGHT_SKY_INL_H_
#endif

#include "base/trig-inl.h"
#include "base/vec3-inl.h"
#include "light/sky.h"

HWY_BEFORE_NAMESPACE();
namespace nacre::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class D, class V = hn::Vec<D>>
HWY_INLINE V Radiance(D d, const GradientSkyTerms<float>& sky, const Vec3V<V>& direction) {
  const V upper = hn::Set(d, sky.zenith - sky.horizon);
  const V lower = hn::Set(d, sky.ground - sky.horizon);
  const V slope = hn::IfThenElse(hn::Gt(direction.y, hn::Zero(d)), upper, lower);
  return hn::MulAdd(slope, hn::Abs(direction.y), hn::Set(d, sky.horizon));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V Irradiance(D d, const GradientSkyTerms<float>& sky, const Vec3V<V>& normal) {
  constexpr float kPi = 3.14159265f;
  const V sin = hn::Sqrt(hn::MulAdd(normal.x, normal.x, hn::Mul(normal.z, normal.z)));
  const V angle = Atan2Upper(d, sin, normal.y);
  const V upper = hn::MulAdd(hn::Sub(hn::Set(d, kPi), angle), normal.y, sin);
  const V lower = hn::NegMulAdd(angle, normal.y, sin);
  return hn::MulAdd(hn::Set(d, (sky.zenith - sky.horizon) * 2 / 3), upper,
                    hn::MulAdd(hn::Set(d, (sky.ground - sky.horizon) * 2 / 3), lower,
                               hn::Set(d, kPi * sky.horizon)));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V CosineFromAxis(D d, const QuadraticSkyTerms<float>& sky, const Vec3V<V>& direction) {
  const Vec3V<V> axis{hn::Set(d, sky.axis.x), hn::Set(d, sky.axis.y), hn::Set(d, sky.axis.z)};
  return FusedDot(axis, direction);
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V Radiance(D d, const QuadraticSkyTerms<float>& sky, const Vec3V<V>& direction) {
  const V c = CosineFromAxis(d, sky, direction);
  return hn::MulAdd(c, hn::MulAdd(c, hn::Set(d, sky.a2), hn::Set(d, sky.a1)), hn::Set(d, sky.a0));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V Irradiance(D d, const QuadraticSkyTerms<float>& sky, const Vec3V<V>& normal) {
  constexpr float kPi = 3.14159265f;
  const V c = CosineFromAxis(d, sky, normal);
  const V slope = hn::MulAdd(c, hn::Set(d, kPi / 4 * sky.a2), hn::Set(d, 2 * kPi / 3 * sky.a1));
  return hn::MulAdd(c, slope, hn::Set(d, kPi * (sky.a0 + sky.a2 / 4)));
}

}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
