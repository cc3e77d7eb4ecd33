// SPDX-License-Identifier: Apache-2.0
// light/area_sample-inl.h: samples of area lights on SIMD vectors: code that all shapes share.
// Scalar twin: area_sample.h.
#if defined(NACRE_LIGHT_AREA_SAMPLE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_LIGHT_AREA_SAMPLE_INL_H_
#undef NACRE_LIGHT_AREA_SAMPLE_INL_H_
#else
#define NACRE_LIGHT_AREA_SAMPLE_INL_H_
#endif

#include "base/math-inl.h"
#include "base/trig-inl.h"
#include "base/vec3-inl.h"
#include "light/area_sample.h"

HWY_BEFORE_NAMESPACE();
namespace nacre::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

inline constexpr float kTwoPi = 6.28318531f;

template <class V>
struct AreaSampleV {
  Vec3V<V> to_light;
  V distance, inverse_pdf, cos_light;
};

template <class M, class V>
HWY_INLINE AreaSampleV<V> Select(M mask, const AreaSampleV<V>& yes, const AreaSampleV<V>& no) {
  return {Select(mask, yes.to_light, no.to_light), hn::IfThenElse(mask, yes.distance, no.distance),
          hn::IfThenElse(mask, yes.inverse_pdf, no.inverse_pdf),
          hn::IfThenElse(mask, yes.cos_light, no.cos_light)};
}

// Returns `sample`, with all members 0 where `mask` is false.
template <class D, class M, class V>
HWY_INLINE AreaSampleV<V> SampleIf(D d, M mask, const AreaSampleV<V>& sample) {
  const V zero = hn::Zero(d);
  return Select(mask, sample, {{zero, zero, zero}, zero, zero, zero});
}

template <class V>
HWY_INLINE V Length(const Vec3V<V>& v) {
  return hn::Sqrt(FusedDot(v, v));
}

template <class V>
HWY_INLINE V Hypot(V x, V y) {
  return hn::Sqrt(hn::MulAdd(x, x, hn::Mul(y, y)));
}

template <class V>
HWY_INLINE V LargestComponent(const Vec3V<V>& v) {
  return hn::Max(hn::Max(hn::Abs(v.x), hn::Abs(v.y)), hn::Abs(v.z));
}

// A rectangle or a triangle. The scalar twins say which points the corner and the edges span.
template <class Shape, class V>
struct FlatLightV {
  Vec3V<V> corner, edge_x, edge_y;
};

// LargestLength is the largest component of the vectors that describe a light. Scaled multiplies
// all of them by a factor.
template <class Shape, class V>
HWY_INLINE V LargestLength(const FlatLightV<Shape, V>& light) {
  const V edges = hn::Max(LargestComponent(light.edge_x), LargestComponent(light.edge_y));
  return hn::Max(LargestComponent(light.corner), edges);
}
template <class Shape, class V>
HWY_INLINE FlatLightV<Shape, V> Scaled(const FlatLightV<Shape, V>& light, V factor) {
  return {Scale(light.corner, factor), Scale(light.edge_x, factor), Scale(light.edge_y, factor)};
}

// A light in units of `unit`, a power of two.
template <class Light, class V>
struct ScaledLightV {
  Light light;
  V unit;
};

// Divides a light's lengths, including its offset from the shaded point, by the power of two in the
// largest of them. The light formulas multiply up to five lengths, and with lengths of 1e-10 or
// 1e10 the products would leave the range of float. Solid angles and irradiances do not change, and
// distances are multiples of `unit`. Where no product would have left the range, no bit of the
// results changes. Light must have LargestLength and Scaled.
template <class D, class Light, class V = hn::Vec<D>>
HWY_INLINE ScaledLightV<Light, V> ScaleToUnit(D d, const Light& light) {
  const PowerOfTwoV<V> unit = PowerOfTwo(d, LargestLength(light));
  return {Scaled(light, unit.inverse), unit.power};
}

// a + b s.
template <class V>
HWY_INLINE Vec3V<V> AddScaled(const Vec3V<V>& a, const Vec3V<V>& b, V s) {
  return {hn::MulAdd(b.x, s, a.x), hn::MulAdd(b.y, s, a.y), hn::MulAdd(b.z, s, a.z)};
}

// a (b x c).
template <class V>
HWY_INLINE V TripleProduct(const Vec3V<V>& a, const Vec3V<V>& b, const Vec3V<V>& c) {
  return FusedDot(a, FusedCross(b, c));
}

// 1 / x, or 0 where x <= 0.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V InverseIfPositive(D d, V x) {
  const V one = hn::Set(d, 1.0f);
  const auto positive = hn::Gt(x, hn::Zero(d));
  return hn::IfThenElseZero(positive, hn::Div(one, hn::IfThenElse(positive, x, one)));
}

}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
