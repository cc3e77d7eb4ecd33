// brdf/lobe_sample-inl.h: directions chosen by what a surface reflects, on SIMD vectors, and how
// densely, per solid angle. All from points (u, v) in [0, 1)^2.
#if defined(NACRE_BRDF_LOBE_SAMPLE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_BRDF_LOBE_SAMPLE_INL_H_
#undef NACRE_BRDF_LOBE_SAMPLE_INL_H_
#else
#define NACRE_BRDF_LOBE_SAMPLE_INL_H_
#endif

#include <limits>

#include "base/basis-inl.h"
#include "base/trig-inl.h"
#include "brdf/ggx-inl.h"
#include "brdf/phong-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class D, class V = hn::Vec<D>>
HWY_INLINE Vec3V<V> Normalized(D d, const Vec3V<V>& a) {
  const V smallest = hn::Set(d, std::numeric_limits<float>::min());
  return Scale(a, ReciprocalSqrt(d, hn::Max(FusedDot(a, a), smallest)));
}

// The direction at the polar angle whose 1 - cos is given, and the azimuth v turns, about an axis.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Vec3V<V> PolarDirection(D d, V one_minus_cos, V v, const Vec3V<V>& axis) {
  const V two = hn::Set(d, 2.0f);
  const V zero = hn::Zero(d);
  const V sin = hn::Sqrt(hn::Max(hn::Mul(one_minus_cos, hn::Sub(two, one_minus_cos)), zero));
  const SinCosV<V> azimuth = SinCosTurns(d, v);
  return ToWorld(BasisAbout(d, axis), {hn::Mul(sin, azimuth.cos), hn::Mul(sin, azimuth.sin),
                                       hn::Sub(hn::Set(d, 1.0f), one_minus_cos)});
}

// By the cosine law: density n.l / pi.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Vec3V<V> SampleCosineLobe(D d, const Vec3V<V>& n, V u, V v) {
  const SinCosV<V> azimuth = SinCosTurns(d, v);
  const V sin = hn::Sqrt(u);
  const V cos = hn::Sqrt(hn::Sub(hn::Set(d, 1.0f), u));
  return ToWorld(BasisAbout(d, n), {hn::Mul(sin, azimuth.cos), hn::Mul(sin, azimuth.sin), cos});
}

// w mirrored in the unit vector h.
template <class V>
HWY_INLINE Vec3V<V> Mirror(const Vec3V<V>& w, const Vec3V<V>& h) {
  const V along = FusedDot(w, h);
  const V twice = hn::Add(along, along);
  return {hn::MulSub(twice, h.x, w.x), hn::MulSub(twice, h.y, w.y), hn::MulSub(twice, h.z, w.z)};
}

// Of a GGX lobe: the view direction mirrored in a normal chosen among those that it sees (Heitz
// 2018, by the caps of Dupuy and Benyoub 2023).
template <class D, class V = hn::Vec<D>>
HWY_INLINE Vec3V<V> SampleGgxLobe(D d, const Vec3V<V>& n, const Vec3V<V>& to_view, V alpha, V u,
                                  V v) {
  const V one = hn::Set(d, 1.0f), zero = hn::Zero(d);
  const BasisV<V> basis = BasisAbout(d, n);
  Vec3V<V> w = ToLocal(basis, to_view);
  w.z = hn::Max(w.z, zero);  // interpolated normals may lean away from the viewer
  const Vec3V<V> stretched = Normalized(d, Vec3V<V>{hn::Mul(alpha, w.x), hn::Mul(alpha, w.y), w.z});
  const SinCosV<V> azimuth = SinCosTurns(d, u);
  // In the cap z > -stretched.z.
  const V z = hn::NegMulAdd(v, hn::Add(one, stretched.z), one);
  const V sin = hn::Sqrt(hn::Max(hn::Mul(hn::Sub(one, z), hn::Add(one, z)), zero));
  const Vec3V<V> sum{hn::MulAdd(sin, azimuth.cos, stretched.x),
                     hn::MulAdd(sin, azimuth.sin, stretched.y), hn::Add(z, stretched.z)};
  const Vec3V<V> h =
      Normalized(d, Vec3V<V>{hn::Mul(alpha, sum.x), hn::Mul(alpha, sum.y), hn::Max(sum.z, zero)});
  return ToWorld(basis, Mirror(w, h));
}

// Its density: the distribution times G1(v) / (4 n.v), which is free of 0/0.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V GgxLobeDensity(D d, V distribution, V n_dot_v, V alpha) {
  const V smallest = hn::Set(d, std::numeric_limits<float>::min());
  const V cosine = hn::Max(n_dot_v, hn::Zero(d));
  const V denominator = hn::Add(cosine, SmithRoot(d, cosine, alpha));
  return hn::Div(hn::Mul(distribution, hn::Set(d, 0.5f)), hn::Max(denominator, smallest));
}

// 1 - 2^y for y <= 0, without the cancellation.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V OneMinusExp2(D d, V y) {
  const V one = hn::Set(d, 1.0f);
  const V t = hn::Mul(y, hn::Set(d, -0.693147181f));
  // 1 - exp(-t) = t - t^2/2 + ...: for t < 1/4 the next term is below 1e-8.
  V p = hn::Set(d, 1.0f / 720);
  for (const float c : {1.0f / 120, 1.0f / 24, 1.0f / 6, 1.0f / 2, 1.0f}) {
    p = hn::NegMulAdd(p, t, hn::Set(d, c));
  }
  return hn::IfThenElse(hn::Lt(t, hn::Set(d, 0.25f)), hn::Mul(p, t), hn::Sub(one, Exp2(d, y)));
}

// A direction with density (n + 1) / (2 pi) c^n about an axis, c its cosine and n the exponent.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Vec3V<V> SamplePowerLobe(D d, const Vec3V<V>& axis, V exponent, V u, V v) {
  const V one = hn::Set(d, 1.0f);
  // Of 1 - u in (0, 1], whose logarithm is finite.
  const V log2 = Log2(d, hn::Sub(one, u));
  const V y = hn::Div(log2, hn::Add(exponent, one));
  return PolarDirection(d, OneMinusExp2(d, y), v, axis);
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
