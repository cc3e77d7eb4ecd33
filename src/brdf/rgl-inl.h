// SPDX-License-Identifier: Apache-2.0
// brdf/rgl-inl.h: tables of EPFL's database, and the unit square of half vectors, on SIMD vectors.
// Scalar twin: brdf/rgl.h.
#if defined(NACRE_BRDF_RGL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_BRDF_RGL_INL_H_
#undef NACRE_BRDF_RGL_INL_H_
#else
#define NACRE_BRDF_RGL_INL_H_
#endif

#include "base/trig-inl.h"
#include "brdf/ggx_anisotropic-inl.h"
#include "brdf/measured_table.h"
#include "brdf/tabulated_warp-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// The angle of (x, y) in [-pi, pi].
template <class D, class V = hn::Vec<D>>
HWY_INLINE V Atan2(D d, V y, V x) {
  return hn::CopySign(Atan2Upper(d, hn::Abs(y), x), y);
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE SquarePointV<V> SquareOf(D d, V theta, V phi) {
  const V pi = hn::Set(d, static_cast<float>(M_PI));
  return {hn::Sqrt(hn::Mul(theta, hn::Set(d, static_cast<float>(M_2_PI)))),
          hn::Mul(hn::Add(phi, pi), hn::Set(d, static_cast<float>(M_1_PI / 2)))};
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V ThetaOf(D d, const Vec3V<V>& local) {
  const V across = hn::Sqrt(hn::MulAdd(local.x, local.x, hn::Mul(local.y, local.y)));
  return Atan2Upper(d, across, local.z);
}

// `tangent` is read of anisotropic BRDFs alone.
template <class D, class V = hn::Vec<D>>
HWY_INLINE BasisV<V> MeasuredFrame(D d, const MeasuredBrdf& brdf, const Vec3V<V>& normal,
                                   const Vec3V<V>& tangent, const Vec3V<V>& to_view) {
  if (brdf.isotropic) return LobeFrame(d, normal, to_view);
  BasisV<V> frame = LobeFrame(d, normal, tangent);
  if (brdf.reduction < 2) return frame;
  const V y = FusedDot(frame.y, to_view);
  const V x = brdf.reduction == 4 ? FusedDot(frame.x, to_view) : y;
  const V zero = hn::Zero(d);
  frame.x = Select(hn::Gt(x, zero), Negated(frame.x), frame.x);
  frame.y = Select(hn::Gt(y, zero), Negated(frame.y), frame.y);
  return frame;
}

template <class D>
struct MeasuredViewerV {
  hn::Vec<D> theta, phi;
  SlicesV<D> slices;
};
template <class D, class V = hn::Vec<D>>
HWY_INLINE MeasuredViewerV<D> ViewerOf(D d, const MeasuredBrdf& brdf, const Vec3V<V>& local) {
  const V theta = ThetaOf(d, local);
  const V phi = brdf.isotropic ? hn::Zero(d) : Atan2(d, local.y, local.x);
  return {theta, phi, SlicesAt(d, brdf.half.angles, phi, theta)};
}

template <class V>
struct HalfSquareV {
  SquarePointV<V> point;
  Vec3V<V> u;  // along the half vector
};
template <class D, class V = hn::Vec<D>>
HWY_INLINE HalfSquareV<V> HalfSquare(D d, const Vec3V<V>& l, const Vec3V<V>& v) {
  const Vec3V<V> u = HalfSum(d, l, v, Sub(l, v));
  return {SquareOf(d, ThetaOf(d, u), Atan2(d, u.y, u.x)), u};
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V InSquare(D d, const SquareTable& of, const SquarePointV<V>& p) {
  const BetweenNodesV<D> i = FindNode(d, of.width, p.x), j = FindNode(d, of.height, p.y);
  const IndexV<D> at = hn::Add(hn::Mul(j.index, SetIndex(d, of.width)), i.index);
  const float* const values = of.values.data();
  return BilinearAt(d, at, of.width, i.fraction, j.fraction,
                    [&](IndexV<D> k) HWY_ATTR { return hn::GatherIndex(d, values, k); });
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE Vec3V<V> EvaluateRgl(D d, const MeasuredBrdf& brdf, const RglTable& table,
                                const Vec3V<V>& l, const Vec3V<V>& v) {
  const MeasuredViewerV<D> viewer = ViewerOf(d, brdf, v);
  const SquarePointV<V> half = HalfSquare(d, l, v).point;
  const SquarePointV<V> s = WarpInverse(d, brdf.half, viewer.slices, half);
  V scale = hn::Set(d, 1.0f);
  if (table.jacobian) {
    const V sigma = InSquare(d, table.sigma, SquareOf(d, viewer.theta, viewer.phi));
    const auto any = hn::Gt(sigma, hn::Zero(d));
    const V divisor = hn::Mul(hn::IfThenElse(any, sigma, scale), hn::Set(d, 4.0f));
    scale = hn::IfThenElseZero(any, hn::Div(InSquare(d, table.ndf, half), divisor));
  }
  const size_t nodes = table.size * table.size;
  const auto channel = [&](size_t c) HWY_ATTR {
    return hn::Mul(scale, BilinearOfSlices(d, viewer.slices, table.rgb.data() + c * nodes,
                                           3 * nodes, table.size, table.size, s));
  };
  return {channel(0), channel(1), channel(2)};
}

}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
