// SPDX-License-Identifier: Apache-2.0
// light/sphere_light-inl.h: sampling spheres as lights on SIMD vectors. Scalar twin:
// sphere_light.h.
#if defined(NACRE_LIGHT_SPHERE_LIGHT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_LIGHT_SPHERE_LIGHT_INL_H_
#undef NACRE_LIGHT_SPHERE_LIGHT_INL_H_
#else
#define NACRE_LIGHT_SPHERE_LIGHT_INL_H_
#endif

#include "base/basis-inl.h"
#include "light/area_sample-inl.h"
#include "light/sphere_light.h"

HWY_BEFORE_NAMESPACE();
namespace nacre::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class V>
struct SphereLightV {
  Vec3V<V> centre;
  V radius;
};

template <class D, class V = hn::Vec<D>>
HWY_INLINE SphereCone<V> ConeOf(D d, const SphereLightV<V>& light) {
  const V one = hn::Set(d, 1.0f);
  const V distance = Length(light.centre);
  const auto outside = hn::Gt(distance, light.radius);
  const V sin =
      hn::IfThenElse(outside, hn::Div(light.radius, hn::IfThenElse(outside, distance, one)), one);
  const V cos = hn::Sqrt(hn::Mul(hn::Sub(one, sin), hn::Add(one, sin)));
  return {distance, sin, hn::Div(hn::Mul(sin, sin), hn::Add(one, cos))};
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V SolidAngle(D d, const SphereLightV<V>& light) {
  const SphereCone<V> cone = ConeOf(d, light);
  return hn::IfThenElse(hn::Lt(cone.distance, light.radius), hn::Set(d, 2 * kTwoPi),
                        hn::Mul(hn::Set(d, kTwoPi), cone.one_minus_cos));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE AreaSampleV<V> SampleSphereFromInside(D d, const SphereLightV<V>& light, V distance,
                                                 V u0, const SinCosV<V>& phi) {
  const V zero = hn::Zero(d);
  const V one = hn::Set(d, 1.0f);
  const V two = hn::Set(d, 2.0f);
  const V r = hn::Mul(two, hn::Sqrt(hn::Mul(u0, hn::Sub(one, u0))));
  const Vec3V<V> to_light{hn::Mul(r, phi.cos), hn::Mul(r, phi.sin), hn::NegMulAdd(two, u0, one)};
  const V along = FusedDot(light.centre, to_light);
  const V power =
      hn::Max(hn::Mul(hn::Sub(light.radius, distance), hn::Add(light.radius, distance)), zero);
  const V root = hn::Sqrt(hn::MulAdd(along, along, power));
  const auto away = hn::Lt(along, zero);
  const V near = hn::Div(power, hn::IfThenElse(away, hn::Sub(root, along), one));
  return {to_light, hn::IfThenElse(away, near, hn::Add(along, root)), hn::Set(d, 2 * kTwoPi),
          hn::Neg(hn::Div(root, light.radius))};
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE AreaSampleV<V> SampleLight(D d, const SphereLightV<V>& light, V u0, V u1) {
  const V zero = hn::Zero(d);
  const V one = hn::Set(d, 1.0f);
  const V two = hn::Set(d, 2.0f);
  const SphereCone<V> cone = ConeOf(d, light);
  const SinCosV<V> phi = SinCosTurns(d, u1);
  const V m = cone.one_minus_cos;
  const V x = hn::Mul(u0, m);
  const V sin = hn::Sqrt(hn::Mul(x, hn::Sub(two, x)));
  const V cos = hn::Sub(one, x);
  const BasisV<V> basis = BasisAbout(d, Scale(light.centre, InverseIfPositive(d, cone.distance)));
  const V chord2 =
      hn::Mul(hn::Mul(m, hn::Sub(one, u0)), hn::Sub(two, hn::Mul(m, hn::Add(one, u0))));
  const V half_chord = hn::Sqrt(hn::Max(chord2, zero));
  const V tangent2 = hn::Mul(hn::Sub(one, cone.sin), hn::Add(one, cone.sin));
  const V farther = hn::Add(cos, half_chord);
  const AreaSampleV<V> outside{
      ToWorld(basis, Vec3V<V>{hn::Mul(sin, phi.cos), hn::Mul(sin, phi.sin), cos}),
      hn::Mul(cone.distance, hn::Mul(tangent2, InverseIfPositive(d, farther))),
      hn::Mul(hn::Set(d, kTwoPi), m), hn::Min(hn::Div(half_chord, cone.sin), one)};
  const auto is_inside = hn::Lt(cone.distance, light.radius);
  const AreaSampleV<V> inside = SampleSphereFromInside(d, light, cone.distance, u0, phi);
  return SampleIf(d, hn::Gt(light.radius, zero), Select(is_inside, inside, outside));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V LightPdf(D d, const SphereLightV<V>& light, const Vec3V<V>& direction) {
  const V zero = hn::Zero(d);
  const SphereCone<V> cone = ConeOf(d, light);
  const Vec3V<V> across = FusedCross(direction, light.centre);
  const auto hit = hn::And(hn::Gt(FusedDot(direction, light.centre), zero),
                           hn::Ge(hn::Mul(light.radius, light.radius), FusedDot(across, across)));
  const V outside = hn::IfThenElseZero(
      hit, InverseIfPositive(d, hn::Mul(hn::Set(d, kTwoPi), cone.one_minus_cos)));
  return hn::IfThenElse(hn::Lt(cone.distance, light.radius), hn::Set(d, 1 / (2 * kTwoPi)), outside);
}

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
  const SphereCone<V> cone = ConeOf(d, light);
  const V c = hn::Mul(FusedDot(normal, light.centre), InverseIfPositive(d, light.radius));
  const V whole = hn::Mul(hn::Mul(pi, hn::Mul(cone.sin, cone.sin)), hn::Mul(cone.sin, c));
  const V clipped = hn::Max(IrradianceOfClippedSphere(d, cone.sin, c), zero);
  const V outside =
      hn::IfThenElseZero(hn::Gt(c, hn::Neg(one)), hn::IfThenElse(hn::Ge(c, one), whole, clipped));
  const V got = hn::IfThenElse(hn::Lt(cone.distance, light.radius), pi, outside);
  return hn::IfThenElseZero(hn::Gt(light.radius, zero), got);
}

}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
