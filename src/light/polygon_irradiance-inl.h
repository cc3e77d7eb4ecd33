// SPDX-License-Identifier: Apache-2.0
// light/polygon_irradiance-inl.h: the irradiance under convex polygons on SIMD vectors. Scalar
// twin, with the derivation: polygon_irradiance.h.
#if defined(NACRE_LIGHT_POLYGON_IRRADIANCE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_LIGHT_POLYGON_IRRADIANCE_INL_H_
#undef NACRE_LIGHT_POLYGON_IRRADIANCE_INL_H_
#else
#define NACRE_LIGHT_POLYGON_IRRADIANCE_INL_H_
#endif

#include <array>

#include "light/rectangle_light-inl.h"
#include "light/triangle_light-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class D, class V = hn::Vec<D>>
HWY_INLINE V EdgeIrradiance(D d, const Vec3V<V>& pivot, const Vec3V<V>& to_a, const Vec3V<V>& to_b,
                            const Vec3V<V>& normal) {
  const V one = hn::Set(d, 1.0f);
  const Vec3V<V> a = Add(pivot, to_a), chord = Sub(to_b, to_a);
  const Vec3V<V> cross = FusedCross(a, chord);
  const V sin = Length(cross);
  const V chord_length = Length(chord), sum_length = Length(Add(Add(a, a), chord));
  const auto is_short = hn::Lt(chord_length, sum_length);
  const V larger = hn::Max(chord_length, sum_length);
  const V t = hn::Div(hn::Min(chord_length, sum_length), larger);
  const V z = hn::Mul(t, t);
  const V remainder = AtanRemainderPolynomial(d, z);
  // t is the tangent of half the arc for a short arc, whose excess is ArcExcess, and the tangent of
  // half the arc's complement for a long one.
  const V of_short = hn::Mul(z, hn::NegMulAdd(hn::Add(one, z), remainder, one));
  const V complement = hn::NegMulAdd(hn::Mul(t, z), remainder, t);  // the arc tangent of t
  const V angle = hn::NegMulAdd(hn::Set(d, 2.0f), complement, hn::Set(d, kTwoPi / 2));
  const V inverse = InverseIfPositive(d, sin);
  const V excess = hn::IfThenElse(is_short, of_short, hn::MulSub(angle, inverse, one));
  const V edge = hn::MulAdd(excess, FusedDot(normal, cross), TripleProduct(normal, to_a, to_b));
  return hn::IfThenElseZero(hn::Gt(sin, hn::Zero(d)), edge);
}

// The function (x - atan x) / x^3 of z = x^2 at the first of two z <= 1, and its difference
// quotient between the two, without cancellation.
template <class V>
struct TwoRemaindersV {
  V first, quotient;
};

template <class D, class V = hn::Vec<D>>
HWY_INLINE TwoRemaindersV<V> TwoAtanRemainders(D d, V first_z, V second_z) {
  V p = hn::Set(d, kAtanRemainder[std::size(kAtanRemainder) - 1]);
  V quotient = hn::Zero(d);
  for (size_t i = std::size(kAtanRemainder) - 1; i-- > 0;) {
    quotient = hn::MulAdd(quotient, second_z, p);
    p = hn::MulAdd(p, first_z, hn::Set(d, kAtanRemainder[i]));
  }
  return {p, quotient};
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V SectorIrradiance(D d, const Vec3V<V>& a, const Vec3V<V>& chord,
                              const Vec3V<V>& normal) {
  const V zero = hn::Zero(d);
  const V one = hn::Set(d, 1.0f);
  const V a_height = FusedDot(normal, a);
  const V b_rise = FusedDot(normal, chord);
  const V heights = hn::Mul(a_height, hn::Add(a_height, b_rise));
  const V c = TripleProduct(normal, a, chord);
  const V q = hn::NegMulAdd(hn::Set(d, 0.5f), FusedDot(chord, chord), one);
  const V p = hn::Sub(q, heights);
  const Vec3V<V> across = AddScaled(Scale(chord, a_height), a, hn::Neg(b_rise));
  const V across2 = FusedDot(across, across);
  const V c2 = hn::Mul(c, c);
  const V m2 = hn::Add(c2, across2);
  const V size = hn::Abs(c);
  const auto is_short = hn::And(hn::Gt(p, size), hn::Gt(hn::Mul(q, q), m2));
  // The power series, in inverses of p and q.
  const V ip = hn::Div(one, hn::IfThenElse(is_short, p, one));
  const V iq = hn::Div(one, hn::IfThenElse(is_short, q, one));
  const V ipq = hn::Mul(ip, iq);
  const V p_tan2 = hn::Mul(c2, hn::Mul(ip, ip)), q_tan2 = hn::Mul(m2, hn::Mul(iq, iq));
  const TwoRemaindersV<V> remainders = TwoAtanRemainders(d, p_tan2, q_tan2);
  const V flat = hn::Mul(c2, hn::Mul(heights, ipq));
  const V iq2 = hn::Mul(iq, iq);
  const V cubes =
      hn::NegMulAdd(across2, hn::Mul(iq2, iq), hn::Mul(flat, hn::MulAdd(ip, hn::Add(ip, iq), iq2)));
  const V squares = hn::NegMulAdd(across2, iq2, hn::Mul(flat, hn::Add(ip, iq)));
  const V by_series =
      hn::Mul(c, hn::NegMulAdd(hn::Mul(q_tan2, iq), hn::Mul(remainders.quotient, squares),
                               hn::NegMulAdd(remainders.first, cubes, hn::Mul(heights, ipq))));
  // The form with angles.
  const V m = hn::Sqrt(m2);
  const V inverse_sum = InverseIfPositive(d, hn::Add(m, size));
  const V y = hn::MulSub(hn::Mul(p, across2), inverse_sum, hn::Mul(size, heights));
  const V shift = Atan2Upper(d, hn::Abs(y), hn::MulAdd(p, q, hn::Mul(size, m)));
  const V tilt =
      hn::Mul(hn::Mul(across2, hn::Mul(inverse_sum, InverseIfPositive(d, m))), Atan2Upper(d, m, q));
  const V sum = hn::Sub(tilt, hn::IfThenElse(hn::Lt(y, zero), hn::Neg(shift), shift));
  return hn::IfThenElse(is_short, by_series, hn::IfThenElse(hn::Lt(c, zero), hn::Neg(sum), sum));
}

// Sums over the edges of a convex polygon above the horizon, and the points where it crosses the
// horizon.
template <class V>
struct EdgeSumsV {
  V chords, sectors;
  Vec3V<V> enters, leaves;
};

template <class D, class V = hn::Vec<D>>
HWY_INLINE void AddEdge(D d, const Vec3V<V>& corner, const Vec3V<V>& pivot, const Vec3V<V>& from,
                        const Vec3V<V>& to, const Vec3V<V>& normal, EdgeSumsV<V>* sums) {
  const V zero = hn::Zero(d);
  const V one = hn::Set(d, 1.0f);
  const V from_height = FusedDot(normal, Add(corner, from));
  const V to_height = FusedDot(normal, Add(corner, to));
  const auto above = hn::Gt(hn::Max(from_height, to_height), zero);
  const auto rises = hn::And(above, hn::Lt(from_height, zero));
  const auto sinks = hn::And(above, hn::Lt(to_height, zero));
  const V fall = hn::Sub(from_height, to_height);
  const auto crosses = hn::Lt(hn::Min(from_height, to_height), zero);
  const V t = hn::Div(from_height, hn::IfThenElse(hn::And(above, crosses), fall, one));
  const Vec3V<V> crossing = AddScaled(from, Sub(to, from), t);
  const Vec3V<V> to_a = UnitDifference(d, corner, Select(rises, crossing, from));
  const Vec3V<V> to_b = UnitDifference(d, corner, Select(sinks, crossing, to));
  const V chords = EdgeIrradiance(d, pivot, to_a, to_b, normal);
  const V sectors = SectorIrradiance(d, Add(pivot, to_a), Sub(to_b, to_a), normal);
  sums->chords = hn::Add(sums->chords, hn::IfThenElseZero(above, chords));
  sums->sectors = hn::Add(sums->sectors, hn::IfThenElseZero(above, sectors));
  const auto starts = hn::And(above, hn::Ge(zero, from_height));
  const auto ends = hn::And(above, hn::Ge(zero, to_height));
  sums->enters = Select(starts, to_a, sums->enters);
  sums->leaves = Select(ends, to_b, sums->leaves);
}

// A light relative to a surface's horizon: `visible` if any of it is above the horizon;
// `needs_sectors` if the horizon clips it or it is low over the horizon, so that its irradiance
// needs SectorIrradiance.
template <class M>
struct HorizonV {
  M visible, needs_sectors;
};

// Of the light whose corners, on the unit sphere, are at these offsets from the pivot.
template <class D, class V = hn::Vec<D>>
HWY_INLINE auto FindHorizon(D d, const Vec3V<V>* unit_offsets, size_t count, const Vec3V<V>& pivot,
                            const Vec3V<V>& normal) {
  const V zero = hn::Zero(d);
  V size2 = zero, highest = zero, lowest = zero;
  for (size_t i = 0; i < count; ++i) {
    const V height = FusedDot(normal, Add(pivot, unit_offsets[i]));
    size2 = hn::Max(size2, FusedDot(unit_offsets[i], unit_offsets[i]));
    highest = hn::Max(highest, height);
    lowest = hn::Min(lowest, height);
  }
  const V highest2 = hn::Mul(highest, highest);
  const auto low = hn::Or(hn::Lt(hn::Mul(highest2, highest2), size2), hn::Lt(lowest, zero));
  return HorizonV<hn::Mask<D>>{hn::Gt(highest, zero), low};
}

// The sum over a polygon of which the horizon may cut off a part. `overhead` is 1 where the normal
// meets the polygon, else 0.
template <class D, class M, class V = hn::Vec<D>>
HWY_INLINE V CutPolygonSum(D d, const EdgeSumsV<V>& sums, const Vec3V<V>& pivot,
                           const Vec3V<V>& normal, M needs_sectors, V overhead) {
  const V closed = hn::Add(sums.chords, EdgeIrradiance(d, pivot, sums.leaves, sums.enters, normal));
  const auto by_sectors = hn::And(needs_sectors, hn::Eq(overhead, hn::Zero(d)));
  return hn::IfThenElse(by_sectors, sums.sectors, closed);
}

// The irradiance, from the sum over the edges. For a needle next to the point that is pure rounding
// error, and is clamped to the irradiance of the hemisphere.
template <class D, class M, class V = hn::Vec<D>>
HWY_INLINE V IrradianceOfSum(D d, M visible, V sum) {
  const V most = hn::Set(d, kTwoPi / 2);
  return hn::IfThenElseZero(visible, hn::Min(hn::Mul(hn::Set(d, 0.5f), hn::Abs(sum)), most));
}

template <size_t kCount, class D, class V = hn::Vec<D>>
HWY_INLINE V PolygonIrradiance(D d, const Vec3V<V>& corner,
                               const std::array<Vec3V<V>, kCount>& from_corner,
                               const Vec3V<V>& normal) {
  const V zero = hn::Zero(d);
  const Vec3V<V> pivot = Scale(corner, InverseIfPositive(d, Length(corner)));
  // Only the sign is needed. It is divided by a power of two, because products with the volume of a
  // polygon whose size is 1e-10 of its distance would underflow.
  const V triple = TripleProduct(corner, from_corner[1], from_corner[2]);
  const V orientation = hn::Mul(triple, PowerOfTwo(d, hn::Abs(triple)).inverse);
  std::array<Vec3V<V>, kCount> unit_offsets;
  V overhead = hn::Set(d, 1.0f);
  for (size_t i = 0; i < kCount; ++i) {
    const Vec3V<V> edge = Sub(from_corner[(i + 1) % kCount], from_corner[i]);
    unit_offsets[i] = UnitDifference(d, corner, from_corner[i]);
    const V side = TripleProduct(normal, Add(corner, from_corner[i]), edge);
    overhead = hn::IfThenElseZero(hn::Gt(hn::Mul(orientation, side), zero), overhead);
  }
  const auto horizon = FindHorizon(d, unit_offsets.data(), kCount, pivot, normal);
  const auto visible = hn::And(hn::Gt(hn::Abs(orientation), zero), horizon.visible);
  if (hn::AllFalse(d, hn::And(horizon.needs_sectors, visible))) {  // far above the horizon
    V sum = zero;
    for (size_t i = 0; i < kCount; ++i) {
      sum = hn::Add(
          sum, EdgeIrradiance(d, pivot, unit_offsets[i], unit_offsets[(i + 1) % kCount], normal));
    }
    return IrradianceOfSum(d, visible, sum);
  }
  const Vec3V<V> none{zero, zero, zero};
  EdgeSumsV<V> sums{zero, zero, none, none};
  for (size_t i = 0; i < kCount; ++i) {
    AddEdge(d, corner, pivot, from_corner[i], from_corner[(i + 1) % kCount], normal, &sums);
  }
  return IrradianceOfSum(d, visible,
                         CutPolygonSum(d, sums, pivot, normal, horizon.needs_sectors, overhead));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V Irradiance(D d, const RectangleLightV<V>& given, const Vec3V<V>& normal) {
  const V zero = hn::Zero(d);
  const RectangleLightV<V> light = ScaleToUnit(d, given).light;
  const std::array<Vec3V<V>, 4> from_corner{Vec3V<V>{zero, zero, zero}, light.edge_x,
                                            Add(light.edge_x, light.edge_y), light.edge_y};
  return PolygonIrradiance(d, light.corner, from_corner, normal);
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V Irradiance(D d, const TriangleLightV<V>& given, const Vec3V<V>& normal) {
  const V zero = hn::Zero(d);
  const TriangleLightV<V> light = ScaleToUnit(d, given).light;
  const std::array<Vec3V<V>, 3> from_corner{Vec3V<V>{zero, zero, zero}, light.edge_x, light.edge_y};
  return PolygonIrradiance(d, light.corner, from_corner, normal);
}

}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
