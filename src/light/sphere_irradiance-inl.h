// SPDX-License-Identifier: Apache-2.0
// light/sphere_irradiance-inl.h: the irradiance under spheres on SIMD vectors. Scalar twin:
// sphere_irradiance.h.
#if defined(NACRE_LIGHT_SPHERE_IRRADIANCE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_LIGHT_SPHERE_IRRADIANCE_INL_H_
#undef NACRE_LIGHT_SPHERE_IRRADIANCE_INL_H_
#else
#define NACRE_LIGHT_SPHERE_IRRADIANCE_INL_H_
#endif

#include "light/sphere_light-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// For c in (-1, 1). The result is finite, but meaningless, for other c.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V IrradianceOfClippedSphere(D d, V sin, V c) {
  const V one = hn::Set(d, 1.0f);
  const V half = hn::Set(d, 0.5f);
  const V cos = hn::Sqrt(hn::Mul(hn::Sub(one, sin), hn::Add(one, sin)));
  const V k = hn::Sqrt(hn::Max(hn::Mul(hn::Sub(one, c), hn::Add(one, c)), hn::Zero(d)));
  const V azimuth = Atan2Upper(d, k, hn::Neg(hn::Mul(c, cos)));
  const V sin3 = hn::Mul(hn::Mul(sin, sin), sin);
  const V k_sin = hn::Mul(k, sin);
  const V near =
      hn::MulAdd(hn::Mul(sin3, c), azimuth, hn::NegMulAdd(k_sin, cos, Atan2Upper(d, k_sin, cos)));
  const auto is_near = hn::Lt(cos, half);
  const V inverse = hn::Div(one, hn::IfThenElse(is_near, one, cos));
  const V k_cos = hn::Mul(k, inverse);
  const V size = hn::Mul(k_cos, sin);
  const V from_horizon = AtanRemainder(d, size);
  const V high = hn::Mul(
      sin3, hn::MulAdd(c, azimuth,
                       hn::Mul(k_cos, hn::NegMulAdd(hn::Mul(k_cos, k_cos), from_horizon, one))));
  const auto is_low = hn::Lt(c, hn::Neg(half));
  const V inverse_c = hn::Div(one, hn::IfThenElse(is_low, c, hn::Neg(one)));
  const V of_rim = AtanRemainder(d, hn::Neg(hn::Mul(k_cos, inverse_c)));
  const V difference = hn::Sub(hn::Mul(of_rim, hn::Mul(inverse_c, inverse_c)), from_horizon);
  const V low = hn::Mul(hn::Mul(hn::Mul(size, size), size), difference);
  return hn::IfThenElse(is_near, near, hn::IfThenElse(is_low, low, high));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V Irradiance(D d, const SphereLightV<V>& light, const Vec3V<V>& normal) {
  const V zero = hn::Zero(d);
  const V one = hn::Set(d, 1.0f);
  const V pi = hn::Set(d, kTwoPi / 2);
  const SphereConeV<V> cone = ConeOf(d, light);
  const V c = hn::Mul(FusedDot(normal, light.centre), InverseIfPositive(d, light.radius));
  const V whole = hn::Mul(hn::Mul(pi, hn::Mul(cone.sin, cone.sin)), hn::Mul(cone.sin, c));
  const V clipped = hn::Max(IrradianceOfClippedSphere(d, cone.sin, c), zero);
  const V outside =
      hn::IfThenElseZero(hn::Gt(c, hn::Neg(one)), hn::IfThenElse(hn::Ge(c, one), whole, clipped));
  const V got = hn::IfThenElse(hn::Lt(cone.distance, light.radius), pi, outside);
  return hn::IfThenElseZero(hn::Gt(light.radius, zero), got);
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
