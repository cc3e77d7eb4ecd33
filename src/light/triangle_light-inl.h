// SPDX-License-Identifier: Apache-2.0
// light/triangle_light-inl.h: sampling triangles as lights on SIMD vectors. Scalar twin:
// triangle_light.h.
#if defined(NACRE_LIGHT_TRIANGLE_LIGHT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_LIGHT_TRIANGLE_LIGHT_INL_H_
#undef NACRE_LIGHT_TRIANGLE_LIGHT_INL_H_
#else
#define NACRE_LIGHT_TRIANGLE_LIGHT_INL_H_
#endif

#include "light/area_sample-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

struct TriangleShape;
template <class V>
using TriangleLightV = FlatLightV<TriangleShape, V>;

template <class D, class V = hn::Vec<D>>
HWY_INLINE Vec3V<V> UnitDifference(D d, const Vec3V<V>& p, const Vec3V<V>& e) {
  const Vec3V<V> q = Add(p, e);
  const V p_length = Length(p), q_length = Length(q);
  const V product = hn::Mul(p_length, hn::Add(p_length, q_length));
  const V along = hn::Mul(FusedDot(e, Add(p, q)), InverseIfPositive(d, product));
  return Scale(AddScaled(e, p, hn::Neg(along)), InverseIfPositive(d, q_length));
}

template <class V>
struct SphericalTriangleV {
  Vec3V<V> a, to_b, to_c;
  V determinant, one_plus_ab, solid_angle;
};

template <class D, class V = hn::Vec<D>>
HWY_INLINE SphericalTriangleV<V> SphericalTriangleOf(D d, const TriangleLightV<V>& light) {
  const V two = hn::Set(d, 2.0f);
  const V half = hn::Set(d, 0.5f);
  SphericalTriangleV<V> t;
  t.a = Scale(light.corner, InverseIfPositive(d, Length(light.corner)));
  t.to_b = UnitDifference(d, light.corner, light.edge_x);
  t.to_c = UnitDifference(d, light.corner, light.edge_y);
  t.determinant = hn::Abs(TripleProduct(t.a, t.to_b, t.to_c));
  const Vec3V<V> b_to_c = Sub(t.to_c, t.to_b);
  t.one_plus_ab = hn::NegMulAdd(half, FusedDot(t.to_b, t.to_b), two);
  const V others = hn::Add(FusedDot(t.to_c, t.to_c), FusedDot(b_to_c, b_to_c));
  const V sum = hn::NegMulAdd(half, others, hn::Add(t.one_plus_ab, two));
  t.solid_angle = hn::IfThenElseZero(hn::Gt(t.determinant, hn::Zero(d)),
                                     hn::Mul(two, Atan2Upper(d, t.determinant, sum)));
  return t;
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V SolidAngle(D d, const TriangleLightV<V>& light) {
  return SphericalTriangleOf(d, ScaleToUnit(d, light).light).solid_angle;
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE Vec3V<V> SampleSphericalTriangle(D d, const SphericalTriangleV<V>& t, V u0, V u1) {
  const V half = hn::Set(d, 0.5f);
  const V c_chord2 = FusedDot(t.to_c, t.to_c);
  const Vec3V<V> unscaled = AddScaled(t.to_c, t.a, hn::Mul(half, c_chord2));
  const Vec3V<V> tangent = Scale(unscaled, InverseIfPositive(d, Length(unscaled)));
  const V turns = hn::Mul(hn::Mul(u0, t.solid_angle), hn::Set(d, 0.5f / kTwoPi));
  const SinCosV<V> half_area = SinCosTurns(d, turns);
  const V numerator = hn::Mul(half_area.sin, t.one_plus_ab);
  const V determinant = hn::Abs(TripleProduct(t.a, t.to_b, tangent));
  const V denominator =
      hn::MulSub(half_area.cos, determinant, hn::Mul(half_area.sin, FusedDot(t.to_b, tangent)));
  const V size2 = hn::MulAdd(numerator, numerator, hn::Mul(denominator, denominator));
  const V scale = hn::Mul(hn::Add(numerator, numerator), InverseIfPositive(d, size2));
  const Vec3V<V> to_c =
      Scale(AddScaled(Scale(tangent, denominator), t.a, hn::Neg(numerator)), scale);
  const Vec3V<V> b = Add(t.a, t.to_b);
  const Vec3V<V> chord = Sub(to_c, t.to_b);
  const V half_chord2 = hn::Mul(half, FusedDot(chord, chord));
  const V x = hn::Mul(u1, half_chord2);
  const Vec3V<V> across = AddScaled(chord, b, half_chord2);
  const V sin = hn::Sqrt(hn::Mul(x, hn::Sub(hn::Set(d, 2.0f), x)));
  const Vec3V<V> direction = AddScaled(Scale(b, hn::Sub(hn::Set(d, 1.0f), x)), across,
                                       hn::Mul(sin, InverseIfPositive(d, Length(across))));
  return Scale(direction, InverseIfPositive(d, Length(direction)));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE AreaSampleV<V> SampleTriangleByArea(D d, const TriangleLightV<V>& light,
                                               const Vec3V<V>& cross, V twice_area, V u0, V u1) {
  const V root = hn::Sqrt(u0);
  const V along_y = hn::Mul(root, u1);
  const Vec3V<V> point = AddScaled(AddScaled(light.corner, light.edge_x, hn::Sub(root, along_y)),
                                   light.edge_y, along_y);
  const V distance = Length(point);
  const V inverse = InverseIfPositive(d, distance);
  const Vec3V<V> to_light = Scale(point, inverse);
  const V towards = FusedDot(to_light, cross);
  return {to_light, distance,
          hn::Mul(hn::Mul(hn::Set(d, 0.5f), hn::Abs(towards)), hn::Mul(inverse, inverse)),
          hn::Neg(hn::Mul(towards, InverseIfPositive(d, twice_area)))};
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE AreaSampleV<V> SampleLight(D d, const TriangleLightV<V>& given, V u0, V u1) {
  const V zero = hn::Zero(d);
  const auto scaled = ScaleToUnit(d, given);
  const TriangleLightV<V>& light = scaled.light;
  const SphericalTriangleV<V> t = SphericalTriangleOf(d, light);
  const Vec3V<V> cross = FusedCross(light.edge_x, light.edge_y);
  const V twice_area = Length(cross);
  const Vec3V<V> to_light = SampleSphericalTriangle(d, t, u0, u1);
  const V towards = FusedDot(to_light, cross);
  const V distance = hn::Div(FusedDot(light.corner, cross), towards);
  const auto ahead = hn::And(hn::Gt(distance, zero), hn::Gt(hn::Abs(towards), zero));
  const AreaSampleV<V> by_angle{to_light, distance, hn::IfThenElseZero(ahead, t.solid_angle),
                                hn::Neg(hn::Mul(towards, InverseIfPositive(d, twice_area)))};
  const AreaSampleV<V> by_area = SampleTriangleByArea(d, light, cross, twice_area, u0, u1);
  const auto small = hn::Lt(t.solid_angle, hn::Set(d, kSmallSolidAngle<float>));
  AreaSampleV<V> sample = Select(small, by_area, by_angle);
  sample.distance = hn::Mul(sample.distance, scaled.unit);
  return SampleIf(d, hn::Gt(hn::Min(t.solid_angle, sample.inverse_pdf), zero), sample);
}

// LightPdf of a direction that is known to meet the triangle.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V PdfInside(D d, const TriangleLightV<V>& given, const Vec3V<V>& direction) {
  const V zero = hn::Zero(d);
  const TriangleLightV<V> light = ScaleToUnit(d, given).light;
  const V solid_angle = SolidAngle(d, light);
  const Vec3V<V> cross = FusedCross(light.edge_x, light.edge_y);
  const V towards = FusedDot(direction, cross);
  const V inverse = InverseIfPositive(d, hn::Abs(towards));
  const V t = hn::Mul(FusedDot(light.corner, cross), inverse);
  const V by_area = hn::Mul(hn::Mul(hn::Add(t, t), t), inverse);
  const auto small = hn::Lt(solid_angle, hn::Set(d, kSmallSolidAngle<float>));
  const V pdf = hn::IfThenElse(small, by_area, InverseIfPositive(d, solid_angle));
  return hn::IfThenElseZero(hn::Gt(solid_angle, zero), pdf);
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V LightPdf(D d, const TriangleLightV<V>& given, const Vec3V<V>& direction) {
  const V zero = hn::Zero(d);
  const TriangleLightV<V> light = ScaleToUnit(d, given).light;
  const V one = hn::Set(d, 1.0f);
  const V solid_angle = SolidAngle(d, light);
  const Vec3V<V> cross = FusedCross(light.edge_x, light.edge_y);
  const V towards = FusedDot(direction, cross);
  const V offset = FusedDot(light.corner, cross);
  const auto ahead = hn::And(hn::Gt(hn::Mul(offset, towards), zero), hn::Gt(solid_angle, zero));
  const V inverse = hn::Div(one, hn::IfThenElse(ahead, towards, one));
  const V t = hn::Mul(offset, inverse);
  const V x = hn::Mul(TripleProduct(light.corner, direction, light.edge_y), inverse);
  const V y = hn::Neg(hn::Mul(TripleProduct(light.corner, direction, light.edge_x), inverse));
  const auto positive = hn::And(hn::Ge(x, zero), hn::Ge(y, zero));
  const auto hit = hn::And(ahead, hn::And(positive, hn::Ge(one, hn::Add(x, y))));
  const V by_area = hn::Mul(hn::Mul(hn::Add(t, t), t), InverseIfPositive(d, hn::Abs(towards)));
  const auto small = hn::Lt(solid_angle, hn::Set(d, kSmallSolidAngle<float>));
  return hn::IfThenElseZero(hit, hn::IfThenElse(small, by_area, InverseIfPositive(d, solid_angle)));
}

}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
