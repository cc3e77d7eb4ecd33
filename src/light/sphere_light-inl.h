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

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class V>
struct SphereLightV {
  Vec3V<V> centre;
  V radius;
};

template <class V>
struct SphereConeV {
  V distance, sin, one_minus_cos;
};

template <class D, class V = hn::Vec<D>>
HWY_INLINE SphereConeV<V> ConeOf(D d, const SphereLightV<V>& light) {
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
  const SphereConeV<V> cone = ConeOf(d, light);
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
  const SphereConeV<V> cone = ConeOf(d, light);
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
  const SphereConeV<V> cone = ConeOf(d, light);
  const Vec3V<V> across = FusedCross(direction, light.centre);
  const auto hit = hn::And(hn::Gt(FusedDot(direction, light.centre), zero),
                           hn::Ge(hn::Mul(light.radius, light.radius), FusedDot(across, across)));
  const V outside = hn::IfThenElseZero(
      hit, InverseIfPositive(d, hn::Mul(hn::Set(d, kTwoPi), cone.one_minus_cos)));
  return hn::IfThenElse(hn::Lt(cone.distance, light.radius), hn::Set(d, 1 / (2 * kTwoPi)), outside);
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
