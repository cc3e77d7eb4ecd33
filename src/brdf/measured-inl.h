// SPDX-License-Identifier: Apache-2.0
// brdf/measured-inl.h: measured BRDFs on SIMD vectors. Scalar twin: brdf/measured.h.
#if defined(NACRE_BRDF_MEASURED_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_BRDF_MEASURED_INL_H_
#undef NACRE_BRDF_MEASURED_INL_H_
#else
#define NACRE_BRDF_MEASURED_INL_H_
#endif

#include <variant>

#include "brdf/lobe_sampling-inl.h"
#include "brdf/measured.h"
#include "brdf/merl-inl.h"
#include "brdf/rgl-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class D, class V = hn::Vec<D>>
HWY_INLINE Vec3V<V> EvaluateMeasured(D d, const MeasuredBrdf& brdf,
                                     MeasuredInterpolation interpolation, const Vec3V<V>& normal,
                                     const Vec3V<V>& tangent, const Vec3V<V>& l,
                                     const Vec3V<V>& v) {
  const V zero = hn::Zero(d), n_dot_l = FusedDot(normal, l);
  const auto above = hn::And(hn::Gt(n_dot_l, zero), hn::Gt(FusedDot(normal, v), zero));
  Vec3V<V> value;
  if (const auto* const merl = std::get_if<MerlTable>(&brdf.table)) {
    const MerlCoordinatesV<V> at = ComputeMerlCoordinates(d, normal, l, v);
    value = Scale(interpolation == MeasuredInterpolation::kNearest
                      ? MerlValue(d, *merl, MerlNearestCell(d, at))
                      : MerlLinear(d, *merl, at),
                  n_dot_l);
  } else {
    const BasisV<V> frame = MeasuredFrame(d, brdf, normal, tangent, v);
    value =
        EvaluateRgl(d, brdf, std::get<RglTable>(brdf.table), ToLocal(frame, l), ToLocal(frame, v));
  }
  return {hn::IfThenElseZero(above, value.x), hn::IfThenElseZero(above, value.y),
          hn::IfThenElseZero(above, value.z)};
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE Vec3V<V> SampleMeasured(D d, const MeasuredBrdf& brdf, const Vec3V<V>& normal,
                                   const Vec3V<V>& tangent, const Vec3V<V>& v, V u0, V u1) {
  constexpr auto kShare = static_cast<float>(kMeasuredCosineShare);
  const V one = hn::Set(d, 1.0f), share = hn::Set(d, kShare);
  const auto is_cosine = hn::Lt(u0, share);
  const V below_one = hn::Set(d, 1 - 0x1p-24f);
  const V again = hn::Mul(hn::Sub(u0, share), hn::Set(d, 1 / (1 - kShare)));
  const BasisV<V> frame = MeasuredFrame(d, brdf, normal, tangent, v);
  const SlicesV<D> slices = ViewerOf(d, brdf, ToLocal(frame, v)).slices;
  SquarePointV<V> p{hn::Min(hn::Max(again, hn::Zero(d)), below_one), u1};
  if (!brdf.luminance.empty()) p = WarpForward(d, brdf.luminance, slices, p);
  p = WarpForward(d, brdf.half, slices, p);
  // theta = x^2 pi / 2 is x^2 / 4 of a turn.
  const SinCosV<V> theta = SinCosTurns(d, hn::Mul(hn::Mul(p.x, p.x), hn::Set(d, 0.25f)));
  const SinCosV<V> phi = SinCosTurns(d, hn::Sub(p.y, hn::Set(d, 0.5f)));
  const Vec3V<V> half =
      ToWorld(frame, Vec3V<V>{hn::Mul(theta.sin, phi.cos), hn::Mul(theta.sin, phi.sin), theta.cos});
  const Vec3V<V> mirrored = Mirrored(v, half);
  if (hn::AllFalse(d, is_cosine)) return mirrored;
  const V of_cosine = hn::Min(hn::Mul(u0, hn::Set(d, 1 / kShare)), below_one);
  const V first = hn::IfThenElse(is_cosine, of_cosine, hn::Sub(one, below_one));
  return Select(is_cosine, SampleCosine(d, normal, first, u1), mirrored);
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V MeasuredPdf(D d, const MeasuredBrdf& brdf, const Vec3V<V>& normal,
                         const Vec3V<V>& tangent, const Vec3V<V>& v, const Vec3V<V>& l) {
  constexpr auto kShare = static_cast<float>(kMeasuredCosineShare);
  const V zero = hn::Zero(d), one = hn::Set(d, 1.0f);
  const V cosine = hn::Mul(CosinePdf(d, FusedDot(normal, l)), hn::Set(d, kShare));
  const BasisV<V> frame = MeasuredFrame(d, brdf, normal, tangent, v);
  const Vec3V<V> local_l = ToLocal(frame, l), local_v = ToLocal(frame, v);
  const SlicesV<D> slices = ViewerOf(d, brdf, local_v).slices;
  const HalfSquareV<V> half = HalfSquare(d, local_l, local_v);
  const V across2 = hn::MulAdd(half.u.x, half.u.x, hn::Mul(half.u.y, half.u.y));
  const V length = hn::Sqrt(hn::MulAdd(half.u.z, half.u.z, across2));
  const auto above = hn::And(hn::Gt(half.u.z, zero), hn::Gt(length, zero));
  const V divisor = hn::IfThenElse(above, length, one);
  V density = WarpDensity(d, brdf.half, slices, half.point);
  if (!brdf.luminance.empty()) {
    density = hn::Mul(density, WarpDensity(d, brdf.luminance, slices,
                                           WarpInverse(d, brdf.half, slices, half.point)));
  }
  const V sin = hn::Div(hn::Sqrt(across2), divisor);
  const V jacobian =
      hn::Max(hn::Mul(hn::Mul(half.point.x, sin), hn::Set(d, static_cast<float>(2 * M_PI * M_PI))),
              hn::Set(d, static_cast<float>(kLeastSquareJacobian)));
  const V by_angle =
      hn::Div(hn::Mul(density, hn::Set(d, (1 - kShare) / 2)), hn::Mul(jacobian, divisor));
  return hn::Add(cosine, hn::IfThenElseZero(above, by_angle));
}

}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
