// SPDX-License-Identifier: Apache-2.0
// brdf/lobe_sampling-inl.h: lobes sampled on SIMD vectors. Scalar twin: brdf/lobe_sampling.h.
//
// Calls of Log2 and Exp2 are qualified: where a kernel includes Highway's math library,
// argument-dependent look-up would find its functions of the same names, too.
#if defined(NACRE_BRDF_LOBE_SAMPLING_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_BRDF_LOBE_SAMPLING_INL_H_
#undef NACRE_BRDF_LOBE_SAMPLING_INL_H_
#else
#define NACRE_BRDF_LOBE_SAMPLING_INL_H_
#endif

#include <cmath>
#include <limits>

#include "base/basis-inl.h"
#include "brdf/ggx-inl.h"
#include "brdf/lobe_sampling.h"
#include "brdf/phong-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class D, class V = hn::Vec<D>>
HWY_INLINE Vec3V<V> SampleCosine(D d, const Vec3V<V>& normal, V u0, V u1) {
  const V one = hn::Set(d, 1.0f);
  const PointOnDisk<V> p = ConcentricDisk(d, u0, u1);
  const V z = hn::Sqrt(hn::Mul(hn::Sub(one, p.radius), hn::Add(one, p.radius)));
  return ToWorld(BasisAbout(d, normal), Vec3V<V>{p.x, p.y, z});
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V CosinePdf(D d, V n_dot_l) {
  return hn::Mul(hn::Max(n_dot_l, hn::Zero(d)), hn::Set(d, static_cast<float>(M_1_PI)));
}

// The half vector in the frame of the lobe. Alphas must not be a delta lobe's, here and below.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Vec3V<V> SampleGgxHalf(D d, const Vec3V<V>& v, V alpha_x, V alpha_y, V u0, V u1) {
  const V one = hn::Set(d, 1.0f);
  const V smallest = hn::Set(d, std::numeric_limits<float>::min());
  const Vec3V<V> scaled{hn::Mul(alpha_x, v.x), hn::Mul(alpha_y, v.y), hn::Max(v.z, hn::Zero(d))};
  const V across2 = hn::MulAdd(scaled.x, scaled.x, hn::Mul(scaled.y, scaled.y));
  const V length = hn::Max(hn::Sqrt(hn::MulAdd(scaled.z, scaled.z, across2)), smallest);
  const Vec3V<V> squeezed = Scale(scaled, hn::Div(one, length));
  const SinCosV<V> phi = SinCosTurns(d, u0);
  const V top = hn::Add(one, squeezed.z);
  const V half_z = hn::Mul(hn::Sub(one, u1), top);
  const V top_square = hn::Mul(length, hn::Add(length, scaled.z));
  const V one_plus_z = hn::Add(half_z, hn::Div(across2, hn::Max(top_square, smallest)));
  const V sin = hn::Sqrt(hn::Mul(hn::Mul(u1, top), one_plus_z));
  const Vec3V<V> half{hn::Mul(alpha_x, hn::MulAdd(sin, phi.cos, squeezed.x)),
                      hn::Mul(alpha_y, hn::MulAdd(sin, phi.sin, squeezed.y)), half_z};
  const V inverse = hn::Div(one, hn::Sqrt(FusedDot(half, half)));
  return Scale(half, inverse);
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE Vec3V<V> SampleGgxVisible(D d, const Vec3V<V>& normal, const Vec3V<V>& to_view, V alpha,
                                     V u0, V u1) {
  const BasisV<V> basis = BasisAbout(d, normal);
  const Vec3V<V> half = SampleGgxHalf(d, ToLocal(basis, to_view), alpha, alpha, u0, u1);
  return Mirrored(to_view, ToWorld(basis, half));
}

// GgxVisiblePdf from a known value of GgxDistribution.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V GgxVisiblePdf(D d, V distribution, V n_dot_v, V alpha) {
  const V cosine = hn::Max(n_dot_v, hn::Zero(d));
  const V sum = hn::Add(cosine, SmithRoot(d, cosine, alpha));
  return hn::Div(distribution, hn::Add(sum, sum));
}

// 1 - 2^y for y <= 0, without cancellation next to 0.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V OneMinusExp2(D d, V y) {
  // The coefficients of 2^y in base/math-inl.h without the first.
  constexpr float kCoefficients[] = {0.693147182f,   0.240226507f,  0.0555032715f,
                                     0.00961805694f, 0.0013400428f, 0.000154614449f};
  const V far = hn::Sub(hn::Set(d, 1.0f), HWY_NAMESPACE::Exp2(d, y));
  const V near = hn::Neg(hn::Mul(y, EvaluatePolynomial(d, kCoefficients, y)));
  return hn::IfThenElse(hn::Gt(y, hn::Set(d, -0.5f)), near, far);
}

// L of the scalar twin with the logarithm to base 2: log2(1 + 1 / spread).
template <class D, class V = hn::Vec<D>>
HWY_INLINE V KullaContyLog2(D d, V spread) {
  const V one = hn::Set(d, 1.0f);
  return hn::Neg(HWY_NAMESPACE::Log2(d, hn::Div(spread, hn::Add(spread, one))));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE Vec3V<V> SampleKullaConty(D d, const Vec3V<V>& normal, V spread, V u0, V u1) {
  const V one = hn::Set(d, 1.0f);
  // spread (2^y - 1) = spread 2^y (1 - 2^-y), without cancellation.
  const V y = hn::Mul(u0, KullaContyLog2(d, spread));
  const V product =
      hn::Mul(hn::Mul(spread, HWY_NAMESPACE::Exp2(d, y)), OneMinusExp2(d, hn::Neg(y)));
  const V squared = hn::Min(product, one);
  const V sin = hn::Sqrt(hn::Sub(one, squared));
  const SinCosV<V> phi = SinCosTurns(d, u1);
  return ToWorld(BasisAbout(d, normal),
                 Vec3V<V>{hn::Mul(sin, phi.cos), hn::Mul(sin, phi.sin), hn::Sqrt(squared)});
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V KullaContyPdf(D d, V n_dot_l, V spread) {
  const V scale = hn::Mul(KullaContyLog2(d, spread), hn::Set(d, 2.17758609f));  // pi log(2)
  const V sum = hn::MulAdd(n_dot_l, n_dot_l, spread);
  return hn::IfThenElseZero(hn::Gt(n_dot_l, hn::Zero(d)), hn::Div(n_dot_l, hn::Mul(sum, scale)));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V OneMinusPowerCosine(D d, V shininess, V u0) {
  const V one = hn::Set(d, 1.0f);
  const V log2 = Log2OneMinus(d, u0, hn::Sub(one, u0));
  return OneMinusExp2(d, hn::Div(log2, hn::Add(shininess, one)));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE hn::Mask<D> IsConstantLobe(D d, V shininess) {
  return hn::Lt(shininess, hn::Set(d, static_cast<float>(kConstantLobeExponent)));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE Vec3V<V> SamplePhongLobe(D d, const Vec3V<V>& normal, const Vec3V<V>& to_view,
                                    V shininess, V u0, V u1) {
  const V x = hn::IfThenElse(IsConstantLobe(d, shininess), hn::Add(u0, u0),
                             OneMinusPowerCosine(d, shininess, u0));
  return DirectionAround(d, Mirrored(to_view, normal), x, u1);
}

// PhongLobePdf from a known value of the lobe c^shininess: (shininess + 1) / 2 pi c^shininess.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V PhongLobePdf(D d, V lobe, V shininess) {
  const V scale =
      hn::Mul(hn::Add(shininess, hn::Set(d, 1.0f)), hn::Set(d, static_cast<float>(M_1_PI / 2)));
  return hn::IfThenElse(IsConstantLobe(d, shininess), hn::Set(d, static_cast<float>(M_1_PI / 4)),
                        hn::Mul(scale, lobe));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE Vec3V<V> SampleBlinnLobe(D d, const Vec3V<V>& normal, const Vec3V<V>& to_view,
                                    V shininess, V u0, V u1) {
  return Mirrored(to_view, DirectionAround(d, normal, OneMinusPowerCosine(d, shininess, u0), u1));
}

// BlinnLobePdf from a known value of the lobe (n.h)^shininess: the pdf of h over 4 v.h, where
// |u| = 2 v.h.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V BlinnLobePdf(D d, V lobe, const AnglesV<V>& a, V shininess) {
  const V zero = hn::Zero(d), one = hn::Set(d, 1.0f);
  const auto above = hn::And(hn::Gt(a.n_dot_u, zero), hn::Gt(a.u_squared, zero));
  const V u_length = hn::Sqrt(hn::IfThenElse(above, a.u_squared, one));
  const V scale = hn::Mul(hn::Add(shininess, one), hn::Set(d, static_cast<float>(M_1_PI / 2)));
  return hn::IfThenElseZero(above, hn::Div(hn::Mul(scale, lobe), hn::Add(u_length, u_length)));
}

}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
