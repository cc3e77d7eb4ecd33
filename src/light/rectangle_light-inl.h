// SPDX-License-Identifier: Apache-2.0
// light/rectangle_light-inl.h: sampling rectangles as lights on SIMD vectors. Scalar twin:
// rectangle_light.h.
#if defined(NACRE_LIGHT_RECTANGLE_LIGHT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_LIGHT_RECTANGLE_LIGHT_INL_H_
#undef NACRE_LIGHT_RECTANGLE_LIGHT_INL_H_
#else
#define NACRE_LIGHT_RECTANGLE_LIGHT_INL_H_
#endif

#include "light/area_sample-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

struct RectangleShape;
template <class V>
using RectangleLightV = FlatLightV<RectangleShape, V>;

template <class V>
struct RectangleViewV {
  Vec3V<V> x_axis, y_axis, normal;
  V width, height, x0, x1, y0, y1, z;
};

template <class D, class V = hn::Vec<D>>
HWY_INLINE RectangleViewV<V> ViewOf(D d, const RectangleLightV<V>& light) {
  RectangleViewV<V> view;
  view.width = Length(light.edge_x);
  view.height = Length(light.edge_y);
  view.x_axis = Scale(light.edge_x, InverseIfPositive(d, view.width));
  view.y_axis = Scale(light.edge_y, InverseIfPositive(d, view.height));
  view.normal = FusedCross(view.x_axis, view.y_axis);
  view.x0 = FusedDot(light.corner, view.x_axis);
  view.x1 = hn::Add(view.x0, view.width);
  view.y0 = FusedDot(light.corner, view.y_axis);
  view.y1 = hn::Add(view.y0, view.height);
  view.z = FusedDot(light.corner, view.normal);
  return view;
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V SolidAngle(D d, const RectangleViewV<V>& view) {
  const V determinant = hn::Mul(hn::Abs(view.z), hn::Mul(view.width, view.height));
  const Vec3V<V> p00{view.x0, view.y0, view.z}, p10{view.x1, view.y0, view.z};
  const Vec3V<V> p01{view.x0, view.y1, view.z}, p11{view.x1, view.y1, view.z};
  const V r00 = Length(p00), r11 = Length(p11);
  const V diagonal = hn::MulAdd(r00, r11, FusedDot(p00, p11));
  const auto half = [&](const Vec3V<V>& p) {
    const V sum = hn::MulAdd(Length(p), diagonal,
                             hn::MulAdd(FusedDot(p, p00), r11, hn::Mul(FusedDot(p, p11), r00)));
    return Atan2Upper(d, determinant, sum);
  };
  const V sum = hn::Add(half(p10), half(p01));
  return hn::IfThenElseZero(hn::Gt(determinant, hn::Zero(d)), hn::Add(sum, sum));
}

// The scalar twin explains the names. The result is undefined where view.z is 0.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V SampleRectangleX(D d, const RectangleViewV<V>& view, V solid_angle, V part) {
  const V zero = hn::Zero(d);
  const V x0 = view.x0, y0 = view.y0, y1 = view.y1, z = hn::Abs(view.z);
  const V across_x = Hypot(x0, z), across_0 = Hypot(y0, z), across_1 = Hypot(y1, z);
  const V r00 = Hypot(across_x, y0), r01 = Hypot(across_x, y1);
  const V b0 = hn::Neg(hn::Div(y0, across_0)), b1 = hn::Div(y1, across_1);
  const V n3z = hn::Neg(hn::Div(x0, across_x));
  const V z_x = hn::Div(z, across_x), z_0 = hn::Div(z, across_0);
  const V sin_g2 = hn::Mul(hn::Div(r01, across_1), z_x), cos_g2 = hn::Neg(hn::Mul(b1, n3z));
  const V sin_g3 = hn::Mul(hn::Div(r00, across_0), z_x), cos_g3 = hn::Neg(hn::Mul(n3z, b0));
  const V y1_r00 = hn::Mul(y1, r00), y0_r01 = hn::Mul(y0, r01);
  const auto same_side = hn::Gt(hn::Mul(y0, y1), zero);
  const V squares = hn::Mul(hn::Mul(view.height, hn::Add(y0, y1)), hn::Mul(across_x, across_x));
  const V sum = hn::IfThenElse(same_side, hn::Add(y1_r00, y0_r01), hn::Set(d, 1.0f));
  const V difference = hn::IfThenElse(same_side, hn::Div(squares, sum), hn::Sub(y1_r00, y0_r01));
  const V q = hn::Mul(z_x, hn::Div(difference, hn::Mul(across_0, across_1)));
  const V sin_k = hn::Mul(n3z, q);
  const V cos_k = hn::Sub(hn::Mul(cos_g2, cos_g3), hn::Mul(sin_g2, sin_g3));
  const V turns = hn::Mul(hn::Mul(part, solid_angle), hn::Set(d, 1 / kTwoPi));
  const SinCosV<V> a = SinCosTurns(d, turns);
  const V sin_half = SinCosTurns(d, hn::Mul(turns, hn::Set(d, 0.5f))).sin;
  const V one_minus_cos = hn::Mul(hn::Set(d, 2.0f), hn::Mul(sin_half, sin_half));
  // The negative of the scalar twin's numerator, so this one is positive.
  const V numerator = hn::MulAdd(hn::Mul(sin_g3, q), a.cos,
                                 hn::MulAdd(b1, one_minus_cos, hn::Mul(hn::Mul(b0, sin_k), a.sin)));
  const V denominator = hn::MulAdd(sin_k, a.cos, hn::Mul(cos_k, a.sin));
  const V shorter = hn::Mul(z_0, denominator);
  const V root2 = hn::Mul(hn::Sub(numerator, shorter), hn::Add(numerator, shorter));
  const auto regular = hn::Gt(root2, zero);
  const V root = hn::Sqrt(hn::IfThenElse(regular, root2, hn::Set(d, 1.0f)));
  const V x = hn::Neg(hn::Div(hn::Mul(z, denominator), root));
  return hn::Min(hn::Max(hn::IfThenElse(regular, x, x0), x0), view.x1);
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V SampleRectangleY(D d, const RectangleViewV<V>& view, V x, V part) {
  const V one = hn::Set(d, 1.0f);
  const V across = Hypot(x, view.z);
  const V h0 = hn::Div(view.y0, Hypot(across, view.y0));
  const V h1 = hn::Div(view.y1, Hypot(across, view.y1));
  const V h = hn::MulAdd(part, hn::Sub(h1, h0), h0);
  const V cos2 = hn::Max(hn::Mul(hn::Sub(one, h), hn::Add(one, h)), hn::Zero(d));
  const V y = hn::Div(hn::Mul(h, across), hn::Sqrt(cos2));  // infinite where cos2 is 0
  return hn::Min(hn::Max(y, view.y0), view.y1);
}

// SampleLight for a light that ScaleToUnit has scaled.
template <class D, class V = hn::Vec<D>>
HWY_INLINE AreaSampleV<V> SampleScaled(D d, const RectangleLightV<V>& light, V u0, V u1) {
  const RectangleViewV<V> view = ViewOf(d, light);
  const V solid_angle = SolidAngle(d, view);
  const auto by_area = hn::Lt(solid_angle, hn::Set(d, kSmallSolidAngle<float>));
  const V x = hn::IfThenElse(by_area, hn::MulAdd(u0, view.width, view.x0),
                             SampleRectangleX(d, view, solid_angle, u0));
  const V y = hn::IfThenElse(by_area, hn::MulAdd(u1, view.height, view.y0),
                             SampleRectangleY(d, view, x, u1));
  const V distance = hn::Sqrt(hn::MulAdd(x, x, hn::MulAdd(y, y, hn::Mul(view.z, view.z))));
  const V inverse = InverseIfPositive(d, distance);
  const Vec3V<V> point =
      AddScaled(AddScaled(Scale(view.x_axis, x), view.y_axis, y), view.normal, view.z);
  const V cos_light = hn::Neg(hn::Mul(view.z, inverse));
  const V area_pdf = hn::Mul(hn::Mul(view.width, view.height),
                             hn::Mul(hn::Abs(cos_light), hn::Mul(inverse, inverse)));
  // Nearer than 2^-62 the distance's square is no normal float.
  const auto visible =
      hn::And(hn::Gt(solid_angle, hn::Zero(d)), hn::Gt(distance, hn::Set(d, 0x1p-62f)));
  return SampleIf(d, visible,
                  AreaSampleV<V>{Scale(point, inverse), distance,
                                 hn::IfThenElse(by_area, area_pdf, solid_angle), cos_light});
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE AreaSampleV<V> SampleLight(D d, const RectangleLightV<V>& light, V u0, V u1) {
  const auto scaled = ScaleToUnit(d, light);
  AreaSampleV<V> sample = SampleScaled(d, scaled.light, u0, u1);
  sample.distance = hn::Mul(sample.distance, scaled.unit);
  return sample;
}

// LightPdf for a light that ScaleToUnit has scaled.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V PdfScaled(D d, const RectangleLightV<V>& light, const Vec3V<V>& direction) {
  const V zero = hn::Zero(d);
  const RectangleViewV<V> view = ViewOf(d, light);
  const V solid_angle = SolidAngle(d, view);
  const V towards = FusedDot(direction, view.normal);
  const auto ahead = hn::And(hn::Gt(hn::Mul(view.z, towards), zero), hn::Gt(solid_angle, zero));
  const V t = hn::Div(view.z, hn::IfThenElse(ahead, towards, hn::Set(d, 1.0f)));
  const V x = hn::Mul(t, FusedDot(direction, view.x_axis));
  const V y = hn::Mul(t, FusedDot(direction, view.y_axis));
  const auto inside_x = hn::And(hn::Ge(x, view.x0), hn::Ge(view.x1, x));
  const auto inside_y = hn::And(hn::Ge(y, view.y0), hn::Ge(view.y1, y));
  const auto hit = hn::And(ahead, hn::And(inside_x, inside_y));
  const V area = hn::Mul(hn::Mul(view.width, view.height), hn::Abs(towards));
  const V by_area = hn::Mul(hn::Mul(t, t), InverseIfPositive(d, area));
  const auto small = hn::Lt(solid_angle, hn::Set(d, kSmallSolidAngle<float>));
  return hn::IfThenElseZero(hit, hn::IfThenElse(small, by_area, InverseIfPositive(d, solid_angle)));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V LightPdf(D d, const RectangleLightV<V>& light, const Vec3V<V>& direction) {
  return PdfScaled(d, ScaleToUnit(d, light).light, direction);
}

}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
