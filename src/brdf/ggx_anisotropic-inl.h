// SPDX-License-Identifier: Apache-2.0
// brdf/ggx_anisotropic-inl.h: anisotropic GGX on SIMD vectors. Scalar twin:
// brdf/ggx_anisotropic.h, which has the papers.
#if defined(NACRE_BRDF_GGX_ANISOTROPIC_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_BRDF_GGX_ANISOTROPIC_INL_H_
#undef NACRE_BRDF_GGX_ANISOTROPIC_INL_H_
#else
#define NACRE_BRDF_GGX_ANISOTROPIC_INL_H_
#endif

#include <cmath>
#include <limits>

#include "base/basis-inl.h"
#include "base/target_ops-inl.h"
#include "brdf/angles-inl.h"
#include "brdf/ggx_anisotropic.h"
#include "brdf/lobe_sampling-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// The alphas along tangent and bitangent, and what the distribution needs of them: lights of a hit
// share it.
template <class V>
struct GgxAlphasV {
  V x, y;
  V y_over_x, x_over_y, product;
};

// Of alphas that are no delta lobe's, as MakeGgxAlphas has them: neither is below its limit, which
// is a power of two and so exact in float.
template <class D, class V = hn::Vec<D>>
HWY_INLINE GgxAlphasV<V> MakeGgxAlphas(D d, V alpha_x, V alpha_y) {
  const V least = hn::Set(d, static_cast<hn::TFromD<D>>(kDeltaRoughness * kDeltaRoughness));
  const V x = hn::Max(alpha_x, least), y = hn::Max(alpha_y, least);
  return {x, y, hn::Div(y, x), hn::Div(x, y), hn::Mul(x, y)};
}

// Towards the bitangent for positive angles.
template <class V>
HWY_INLINE Vec3V<V> RotatedTangent(const Vec3V<V>& normal, const Vec3V<V>& tangent, V cos, V sin) {
  const Vec3V<V> bitangent = FusedCross(normal, tangent);
  return MulAdd3(bitangent, sin, Scale(tangent, cos));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE BasisV<V> LobeFrame(D d, const Vec3V<V>& normal, const Vec3V<V>& tangent) {
  using T = hn::TFromD<D>;
  const V zero = hn::Zero(d), one = hn::Set(d, T(1));
  const V largest = hn::Max(hn::Max(hn::Abs(tangent.x), hn::Abs(tangent.y)), hn::Abs(tangent.z));
  // The largest finite number divides normal numbers to normal numbers or 0.
  const auto usable =
      hn::And(hn::Gt(largest, zero), hn::Le(largest, hn::Set(d, std::numeric_limits<T>::max())));
  const V divisor = hn::IfThenElse(usable, largest, one);
  const Vec3V<V> scaled{hn::Div(tangent.x, divisor), hn::Div(tangent.y, divisor),
                        hn::Div(tangent.z, divisor)};
  const auto remove_normal = [&](const Vec3V<V>& a) HWY_ATTR {
    const V along = FusedDot(normal, a);
    return Vec3V<V>{hn::NegMulAdd(normal.x, along, a.x), hn::NegMulAdd(normal.y, along, a.y),
                    hn::NegMulAdd(normal.z, along, a.z)};
  };
  const Vec3V<V> across = remove_normal(remove_normal(scaled));
  const V length2 = FusedDot(across, across);
  const T rounding = 8 * std::numeric_limits<T>::epsilon();
  const auto has_direction =
      hn::And(usable, hn::Gt(length2, hn::Set(d, static_cast<T>(rounding * rounding))));
  const V inverse = hn::Div(one, hn::Sqrt(hn::IfThenElse(has_direction, length2, one)));
  const Vec3V<V> x = Select(has_direction, Scale(across, inverse), BasisAbout(d, normal).x);
  return {x, FusedCross(normal, x), normal};
}

template <class V>
struct FrameAnglesV : AnglesV<V> {
  V t_dot_u, b_dot_u;
  V t_dot_l, b_dot_l;
  V t_dot_v, b_dot_v;
};

// Components of u are taken of u - n (n.u), so that a tangent that rounding tilts out of the
// surface is wrong by that to second order only.
template <class D, class V = hn::Vec<D>>
HWY_INLINE FrameAnglesV<V> ComputeAngles(D d, const BasisV<V>& frame, const Vec3V<V>& l,
                                         const Vec3V<V>& v) {
  const Vec3V<V>& n = frame.z;
  const Vec3V<V> l_minus_v = Sub(l, v);
  const Vec3V<V> u = HalfSum(d, l, v, l_minus_v);
  const V n_dot_u = FusedDot(n, u);
  const Vec3V<V> across{hn::NegMulAdd(n.x, n_dot_u, u.x), hn::NegMulAdd(n.y, n_dot_u, u.y),
                        hn::NegMulAdd(n.z, n_dot_u, u.z)};
  return {{HalfAnglesOf(d, n, u, n_dot_u, l_minus_v), FusedDot(n, l), FusedDot(n, v)},
          FusedDot(frame.x, across),
          FusedDot(frame.y, across),
          FusedDot(frame.x, l),
          FusedDot(frame.y, l),
          FusedDot(frame.x, v),
          FusedDot(frame.y, v)};
}

// ax ay |u|^2 ((t.h / ax)^2 + (b.h / ay)^2 + (n.h)^2). A kernel that merges its divisions computes
// the distribution from it: ax ay |u|^4 / (pi denominator^2). There is no test for h below the
// surface.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V GgxRootDenominator(D, const FrameAnglesV<V>& a, const GgxAlphasV<V>& alpha) {
  const V up = hn::Mul(hn::Mul(a.n_dot_u, alpha.x), hn::Mul(a.n_dot_u, alpha.y));
  const V along = hn::MulAdd(hn::Mul(a.t_dot_u, a.t_dot_u), alpha.y_over_x, up);
  return hn::MulAdd(hn::Mul(a.b_dot_u, a.b_dot_u), alpha.x_over_y, along);
}

// Burley 2012, eq. 13. 0 where h lies below the surface.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V GgxDistribution(D d, const FrameAnglesV<V>& a, const GgxAlphasV<V>& alpha) {
  const V zero = hn::Zero(d);
  const V denominator = GgxRootDenominator(d, a, alpha);
  const auto above = hn::And(hn::Gt(a.n_dot_u, zero), hn::Gt(denominator, zero));
  const V k =
      hn::Div(a.u_squared, hn::IfThenElse(above, denominator, hn::Set(d, hn::TFromD<D>(1))));
  const V squared = hn::Mul(hn::Mul(alpha.x, k), hn::Mul(alpha.y, k));
  return hn::IfThenElseZero(above, hn::Mul(squared, hn::Set(d, hn::TFromD<D>(M_1_PI))));
}

// The smallest normal number keeps the root of a view along a streak's axis in range.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V SmithRoot(D d, V n_dot_x, V t_dot_x, V b_dot_x, const GgxAlphasV<V>& alpha) {
  const V x = hn::Mul(alpha.x, t_dot_x), y = hn::Mul(alpha.y, b_dot_x);
  const V smallest = hn::Set(d, std::numeric_limits<hn::TFromD<D>>::min());
  const V across = hn::MulAdd(x, x, hn::MulAdd(y, y, smallest));
  return SquareRoot(d, hn::MulAdd(n_dot_x, n_dot_x, across));
}
template <class D, class V = hn::Vec<D>>
HWY_INLINE V SmithRootOfLight(D d, const FrameAnglesV<V>& a, const GgxAlphasV<V>& alpha) {
  return SmithRoot(d, a.n_dot_l, a.t_dot_l, a.b_dot_l, alpha);
}
template <class D, class V = hn::Vec<D>>
HWY_INLINE V SmithRootOfView(D d, const FrameAnglesV<V>& a, const GgxAlphasV<V>& alpha) {
  return SmithRoot(d, hn::Max(a.n_dot_v, hn::Zero(d)), a.t_dot_v, a.b_dot_v, alpha);
}

// The denominators of the visibility terms times `scale`, so that a kernel can merge its divisions.
// The roots are those of SmithRootOfLight and SmithRootOfView. Heitz 2014, eq. 99.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V VisibilityDenominatorHeightCorrelated(D d, const FrameAnglesV<V>& a, V light_root,
                                                   V view_root, V scale) {
  const V n_dot_v = hn::Max(a.n_dot_v, hn::Zero(d));
  const V sum = hn::MulAdd(a.n_dot_l, view_root, hn::Mul(n_dot_v, light_root));
  return hn::Mul(sum, hn::Add(scale, scale));
}

// Walter et al. 2007, eq. 23.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V VisibilityDenominatorSeparable(D d, const FrameAnglesV<V>& a, V light_root,
                                            V view_root, V scale) {
  const V n_dot_v = hn::Max(a.n_dot_v, hn::Zero(d));
  return hn::Mul(hn::Mul(hn::Add(a.n_dot_l, light_root), hn::Add(n_dot_v, view_root)), scale);
}

// Alphas must not be a delta lobe's.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Vec3V<V> SampleGgxVisible(D d, const BasisV<V>& frame, const Vec3V<V>& to_view,
                                     const GgxAlphasV<V>& alpha, V u0, V u1) {
  const Vec3V<V> half = SampleGgxHalf(d, ToLocal(frame, to_view), alpha.x, alpha.y, u0, u1);
  return Mirrored(to_view, ToWorld(frame, half));
}

// GgxVisiblePdf from known values of GgxDistribution and SmithRootOfView.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V GgxVisiblePdf(D d, V distribution, const FrameAnglesV<V>& a, V view_root) {
  const V sum = hn::Add(hn::Max(a.n_dot_v, hn::Zero(d)), view_root);
  return hn::Div(distribution, hn::Add(sum, sum));
}

}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
