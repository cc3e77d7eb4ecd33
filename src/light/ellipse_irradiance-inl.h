// SPDX-License-Identifier: Apache-2.0
// light/ellipse_irradiance-inl.h: the irradiance under ellipses on SIMD vectors of doubles. Scalar
// twin: ellipse_irradiance.h. Ellipses that the horizon cuts take it, lane by lane.
#if defined(NACRE_LIGHT_ELLIPSE_IRRADIANCE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_LIGHT_ELLIPSE_IRRADIANCE_INL_H_
#undef NACRE_LIGHT_ELLIPSE_IRRADIANCE_INL_H_
#else
#define NACRE_LIGHT_ELLIPSE_IRRADIANCE_INL_H_
#endif

#include "light/area_sample-inl.h"
#include "light/ellipse_irradiance.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class V>
struct EllipseLightV {
  Vec3V<V> centre, x, y;
};

template <class D, class V = hn::Vec<D>>
HWY_INLINE V LargestRoot(D d, V trace, V minors, V determinant2, V y) {
  const V zero = hn::Zero(d), three = hn::Set(d, 3.0);
  const V two_traces = hn::Add(trace, trace);
  for (int i = 0; i < kRootSteps; ++i) {
    const V p = hn::MulSub(hn::MulAdd(hn::Add(y, trace), y, minors), y, determinant2);
    const V slope = hn::MulAdd(hn::MulAdd(three, y, two_traces), y, minors);
    const V curve = hn::Mul(hn::Set(d, 12.0), hn::Mul(p, hn::MulAdd(three, y, trace)));
    const V root = hn::MulSub(hn::Mul(hn::Set(d, 4.0), slope), slope, curve);
    const auto above = hn::Gt(p, zero);
    if (hn::AllFalse(d, above)) break;
    const V divisor = hn::Add(slope, hn::Sqrt(hn::Max(root, zero)));
    const V step = hn::Div(hn::Mul(three, p), hn::IfThenElse(above, divisor, three));
    y = hn::Sub(y, hn::IfThenElseZero(above, step));
    const auto coarse = hn::Gt(step, hn::Mul(hn::Set(d, kRootRounding), y));
    if (hn::AllFalse(d, hn::And(above, coarse))) break;
  }
  return y;
}

// All above the horizon; any number of those that are not.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V IrradianceOfWholeEllipse(D d, const EllipseLightV<V>& light, const Vec3V<V>& normal) {
  const Vec3V<V>&c = light.centre, &x = light.x, &y = light.y;
  const Vec3V<V> cross = FusedCross(x, y), yc = FusedCross(y, c), cx = FusedCross(c, x);
  const V signed_determinant = FusedDot(cross, c), zero = hn::Zero(d);
  const V determinant = hn::Abs(signed_determinant);
  const V sign =
      hn::IfThenElse(hn::Lt(signed_determinant, zero), hn::Set(d, -1.0), hn::Set(d, 1.0));
  const Vec3V<V> across = Scale(cross, sign);
  const V c2 = FusedDot(c, c), across2 = FusedDot(across, across);
  const V trace = hn::Sub(hn::Add(FusedDot(x, x), FusedDot(y, y)), c2);
  const V minors = hn::Sub(hn::Sub(across2, FusedDot(yc, yc)), FusedDot(cx, cx));
  const V flat = LargestRoot(d, trace, minors, hn::Mul(determinant, determinant), c2);
  const V slope = hn::MulAdd(hn::Set(d, 3.0), flat, hn::Add(trace, trace));
  const V widths = hn::MulAdd(slope, flat, minors);
  const Vec3V<V> seed = AddScaled(Scale(c, hn::Sqrt(across2)), across, hn::Sqrt(c2));
  Vec3V<V> rest = Scale(seed, hn::Add(trace, flat));
  rest = AddScaled(rest, x, hn::Neg(FusedDot(x, seed)));
  rest = AddScaled(rest, y, hn::Neg(FusedDot(y, seed)));
  rest = AddScaled(rest, c, FusedDot(c, seed));
  Vec3V<V> column = AddScaled(Scale(rest, flat), across, FusedDot(across, seed));
  column = AddScaled(column, yc, hn::Neg(FusedDot(yc, seed)));
  column = AddScaled(column, cx, hn::Neg(FusedDot(cx, seed)));
  const V cosine = hn::Mul(FusedDot(column, normal), InverseIfPositive(d, Length(column)));
  const V flow = hn::Mul(determinant, InverseIfPositive(d, hn::Sqrt(hn::Mul(flat, widths))));
  return hn::Mul(hn::Mul(hn::Set(d, M_PI), flow), cosine);
}

// Replaces the lanes of ellipses that cross the horizon.
template <class D, class V>
HWY_NOINLINE void FillRisingEllipses(D d, const EllipseLightV<V>& light, const Vec3V<V>& normal,
                                     V* irradiance) {
  constexpr size_t kMaxLanes = 64 / sizeof(double);
  alignas(64) double lanes[4][3][kMaxLanes];
  alignas(64) double results[kMaxLanes];
  Store3(light.centre, d, lanes[0][0], lanes[0][1], lanes[0][2]);
  Store3(light.x, d, lanes[1][0], lanes[1][1], lanes[1][2]);
  Store3(light.y, d, lanes[2][0], lanes[2][1], lanes[2][2]);
  Store3(normal, d, lanes[3][0], lanes[3][1], lanes[3][2]);
  hn::Store(*irradiance, d, results);
  for (size_t i = 0; i < hn::Lanes(d); ++i) {
    const auto at = [&](size_t k) { return Vec3d(lanes[k][0][i], lanes[k][1][i], lanes[k][2][i]); };
    const EllipseLight lane{at(0), at(1), at(2)};
    if (IsCut(lane, at(3))) results[i] = Irradiance(lane, at(3));
  }
  *irradiance = hn::Load(d, results);
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V Irradiance(D d, const EllipseLightV<V>& light, const Vec3V<V>& normal) {
  const V height = FusedDot(light.centre, normal);
  const V rim_height = Hypot(FusedDot(light.x, normal), FusedDot(light.y, normal));
  const auto seen = hn::Gt(height, hn::Neg(rim_height));
  if (hn::AllFalse(d, seen)) return hn::Zero(d);
  const auto rises = hn::And(seen, hn::Lt(height, rim_height));
  V irradiance = IrradianceOfWholeEllipse(d, light, normal);
  if (!hn::AllFalse(d, rises)) FillRisingEllipses(d, light, normal, &irradiance);
  return hn::IfThenElseZero(seen, irradiance);
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
